// Elements in the false minimum of the stable neo-Hookean energy, F = 0.

#include "scenes.h"

#include <pent/simulator/energy.h>
#include <pent/simulator/simulation.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>

namespace pent::simulator {
namespace {

using Eigen::MatrixXd;

Material rubber(int dim, double poisson) {
    return {.model = Model::StableNeoHookean, .lame = lame_from_young(dim, 1e5, poisson)};
}

Material mooney_rivlin(int dim, double poisson, double part) {
    return {.model = Model::MooneyRivlin,
            .lame = lame_from_young(dim, 1e5, poisson),
            .second_invariant = part};
}

// In 4D the equation of collapse_scale() divided by 1 - s^2 is s^2 (1 + s^2) = mu / (lambda + mu),
// and mu / (lambda + mu) = (1 - 3 nu) / (1 - nu): 2/9 at nu = 0.28, 1 at nu = 0.
TEST(CollapseScale, IsTheRootWorkedOutByHand) {
    const auto root = [](double ratio) { return std::sqrt((std::sqrt(1 + 4 * ratio) - 1) / 2); };
    EXPECT_NEAR(collapse_scale(rubber(4, 0.28), 4), root(2.0 / 9), 1e-14);
    EXPECT_NEAR(collapse_scale(rubber(4, 0), 4), root(1), 1e-14);
    EXPECT_NEAR(collapse_scale(rubber(4, 0.28), 4), 0.43, 0.005);
}

// With c1 and k of energy.h the equation of mooney-rivlin in 4D, divided by 1 - s^2, is
// k s^2 (1 + s^2) = 2 c1.
TEST(CollapseScale, OfMooneyRivlinIsTheRootWorkedOutByHandAndSmallerTheMoreTheSecondInvariantHas) {
    double before = collapse_scale(rubber(4, 0.28), 4);
    for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        const Material material = mooney_rivlin(4, 0.28, part);
        const auto& [lambda, mu] = material.lame;
        const double twice_c1 = mu * (1 - part);
        const double k = lambda + mu - mu * part / 2;
        const double root = std::sqrt((std::sqrt(1 + 4 * twice_c1 / k) - 1) / 2);
        EXPECT_NEAR(collapse_scale(material, 4), root, 1e-14);
        EXPECT_LE(collapse_scale(material, 4), before + 1e-14);
        before = collapse_scale(material, 4);
    }
    EXPECT_EQ(collapse_scale(mooney_rivlin(4, 0.28, 1), 4), 0);
    EXPECT_EQ(collapse_scale(mooney_rivlin(3, 0.28, 1), 3), 0);
}

TEST(CollapseScale, IsZeroWhereTheEnergyHasNoMinimumAtAPoint) {
    EXPECT_EQ(collapse_scale(rubber(2, 0.28), 2), 0);
    for (const Model model : {Model::Arap, Model::StVenantKirchhoff, Model::Linear}) {
        EXPECT_EQ(collapse_scale({.model = model, .lame = {.lambda = 1, .mu = 1}}, 4), 0);
    }
}

// P : F is the slope of the energy along F itself. It is positive in the whole ball, so that |F|
// shrinks, and negative just outside of it at a rotation, so that no larger ball would do.
TEST(CollapseScale, BoundsTheLargestBallThatIsDrivenToAPoint) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> within(0, 1);
    for (const int dim : {3, 4}) {
        for (const Material& material :
             {rubber(dim, -0.2), rubber(dim, 0), rubber(dim, 0.1), rubber(dim, 0.28),
              rubber(dim, 0.32), mooney_rivlin(dim, 0.28, 0.3), mooney_rivlin(dim, 0, 0.9)}) {
            const double scale = collapse_scale(material, dim);
            for (int sample = 0; sample < 200; ++sample) {
                MatrixXd F = MatrixXd::NullaryExpr(dim, dim, [&]() { return normal(random); });
                F *= std::sqrt(dim) * scale * within(random) / F.norm();
                EXPECT_GT(stress(material, F).cwiseProduct(F).sum(), 0);
            }
            const MatrixXd identity = MatrixXd::Identity(dim, dim);
            EXPECT_LT(stress(material, scale * identity).norm(), 1e-9 * material.lame.mu);
            EXPECT_LT(stress(material, 1.01 * scale * identity).trace(), 0);
        }
    }
}

// A heavily damped free body released from `start`; gives the report after `steps`.
StepReport release(const Positions<4>& start,
                   const SimplexMesh<4>& mesh,
                   int steps,
                   const std::optional<Material>& material = {}) {
    Scene scene = test::box_scene<4>();
    scene.bodies[0].material = material.value_or(scene.bodies[0].material);
    scene.solver.integrator = Integrator::NewtonEuler;
    scene.damping = Damping{.mass = 20, .stiffness = 0};
    Simulation<4> simulation(scene, {mesh});
    simulation.set_state(0, start, Positions<4>::Zero(4, start.cols()));
    StepReport report;
    for (int i = 0; i < steps; ++i) {
        report = simulation.step();
        EXPECT_TRUE(report.is_accepted) << report.failure;
    }
    return report;
}

SimplexMesh<4> small_box() {
    return pent::test::kuhn_box<4>({2, 1, 1, 1}, {1, 0.5, 0.5, 0.5});
}

TEST(CollapsedBody, IsReportedAndStaysAPoint) {
    const SimplexMesh<4> mesh = small_box();
    const StepReport report = release(Positions<4>::Zero(4, mesh.vertex_count()), mesh, 3);
    EXPECT_EQ(report.collapsed, mesh.cell_count());
}

// The basin of a uniform scale ends at 0.43 (nu = 0.28).
TEST(CollapsedBody, ReturnsFromAUniformScaleAboveTheLimitAndNotFromBelow) {
    const SimplexMesh<4> mesh = small_box();
    EXPECT_EQ(release(0.45 * mesh.positions, mesh, 60).collapsed, 0);
    EXPECT_EQ(release(0.41 * mesh.positions, mesh, 60).collapsed, mesh.cell_count());
}

// All shear on the second invariant, and there is no minimum to fall into: from a tenth of its
// size, and from inside out, a body comes back whole. (From next to nothing it takes long: the
// force there grows like the cube of the size.)
TEST(MooneyRivlinBody, ReturnsFromATenthOfItsSizeAndFromInsideOut) {
    const SimplexMesh<4> mesh = small_box();
    for (Positions<4> start : {Positions<4>(0.1 * mesh.positions), mesh.positions}) {
        if (start == mesh.positions) {
            start.row(3) *= -0.5;
        }
        const StepReport report = release(start, mesh, 120, mooney_rivlin(4, 0.28, 1));
        EXPECT_EQ(report.collapsed, 0);
        EXPECT_EQ(report.inverted, 0);
        EXPECT_LT(report.energies.of("elastic"), 1);  // J; of 1e4 at the start
    }
}

// Vertices exchanged at random: about half of the elements are inside out, and all shrink to
// nothing.
TEST(ScrambledBody, CollapsesAndIsReported) {
    const SimplexMesh<4> mesh = pent::test::kuhn_box<4>({2, 2, 2, 2}, {1, 1, 1, 1});
    std::vector<Eigen::Index> order(static_cast<std::size_t>(mesh.vertex_count()));
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(1));
    const Positions<4> scrambled = mesh.positions(Eigen::all, order);
    const StepReport report = release(scrambled, mesh, 20);
    EXPECT_EQ(report.collapsed, mesh.cell_count());
    // The energy density of F = 0 is (lambda + mu)/2 - mu; mu = 1e5 / 2.56, lambda = 3.5 mu.
    EXPECT_NEAR(report.energies.of("elastic"), 1.25e5 / 2.56, 1);
}

TEST(FlattenedBody, IsNotReportedAsCollapsed) {
    const SimplexMesh<4> mesh = small_box();
    Positions<4> flat = mesh.positions;
    flat.row(3).setZero();
    EXPECT_EQ(release(flat, mesh, 1).collapsed, 0);
    EXPECT_EQ(release(mesh.positions, mesh, 1).collapsed, 0);
}

}  // namespace
}  // namespace pent::simulator
