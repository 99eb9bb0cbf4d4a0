#include "contact_scenes.h"
#include "elastic_box.h"
#include "scenes.h"
#include "support/messages.h"

#include <pent/error.h>
#include <pent/simulator/energy.h>
#include <pent/simulator/rigid_fit.h>
#include <pent/simulator/simulation.h>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <cmath>

namespace pent::simulator {
namespace {

using test::box_scene;
using test::ElasticBox;
using test::hold;
using test::still;

const HalfSpaceSelection kLeftEnd{.normal = Eigen::Vector4d(1, 0, 0, 0), .offset = 1e-6};

// A box whose inner vertices lie irregularly, with its boundary held: how a patch test wants it.
struct Patch {
    SimplexMesh<4> mesh = pent::test::kuhn_box<4>({3, 3, 3, 3}, {1, 1, 1, 1});
    std::vector<bool> is_boundary;
    DofMap dofs;

    Patch() {
        std::mt19937 random(1);
        std::uniform_real_distribution<double> shake(-0.05, 0.05);
        std::vector<std::uint32_t> own;
        for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
            auto x = mesh.positions.col(v);
            is_boundary.push_back(x.minCoeff() < 1e-9 || x.maxCoeff() > 1 - 1e-9);
            own.push_back(static_cast<std::uint32_t>(v));
            if (!is_boundary.back()) {
                x = x.unaryExpr([&](double c) { return c + shake(random); }).eval();
            }
        }
        validate(mesh, "patch");
        dofs = number_dofs<4>(mesh.cells, is_boundary, {own, own});
    }
};

// With its boundary moved linearly, a body of linear material ends in the linear field, exactly.
TEST(PatchTest, LinearFieldsAreExact) {
    const Patch patch;
    const BlockPattern pattern = make_pattern<4>(patch.mesh.cells, patch.dofs);
    const Material material{.model = Model::Linear, .lame = {.lambda = 1.5, .mu = 1}};
    const std::vector<CellRange> ranges = {{0, patch.mesh.cell_count(), material}};
    const Elements<4> elements(patch.mesh.positions, patch.mesh.cells, ranges, patch.dofs, pattern);
    Eigen::Matrix4d gradient = Eigen::Matrix4d::Identity();
    gradient(0, 3) = 0.3;
    gradient(1, 1) = 1.2;
    gradient(2, 0) = -0.1;
    const Positions<4> linear = gradient * patch.mesh.positions;
    Positions<4> prescribed_displacement = Positions<4>::Zero(4, patch.mesh.vertex_count());
    for (Eigen::Index v = 0; v < patch.mesh.vertex_count(); ++v) {
        if (patch.is_boundary[static_cast<std::size_t>(v)]) {
            prescribed_displacement.col(v) = linear.col(v) - patch.mesh.positions.col(v);
        }
    }
    BlockMatrix<4, double> K(pattern);
    BlockVector<4> right = BlockVector<4>::Zero(4, pattern.rows());
    HessianTarget<double> target = target_in(K, 1, Filter::None);
    target.prescribed_displacement = prescribed_displacement.data();
    target.right = right.data();
    elements.add_hessian(Workers(1), kernels<4>(best_isa()), patch.mesh.positions, target);
    const Eigen::VectorXd moved = ElasticBox<4>::dense(K).ldlt().solve(right.reshaped());
    for (std::uint32_t u = 0; u < patch.dofs.count(); ++u) {
        const std::uint32_t vertex = patch.dofs.vertex_of(u);
        const Eigen::Vector4d expected = linear.col(vertex) - patch.mesh.positions.col(vertex);
        EXPECT_LT((moved.segment<4>(4 * u) - expected).norm(), 1e-12);
    }
}

// Stretched by e along x with free sides, the material narrows by nu e in all other directions and
// pulls with E e. Sides are found by Newton's method on their stress.
TEST(UniaxialStress, GivesYoungAndPoissonInAllDirections) {
    for (const int dim : {2, 3, 4}) {
        const double poisson = 0.28;
        const Material material{.model = Model::StableNeoHookean,
                                .lame = lame_from_young(dim, 1e5, poisson)};
        const double e = 1e-6;
        double side = 0;
        Eigen::MatrixXd P;
        for (int iteration = 0; iteration < 5; ++iteration) {
            const auto stress_at = [&](double s) {
                Eigen::VectorXd stretch = Eigen::VectorXd::Constant(dim, 1 + s);
                stretch[0] = 1 + e;
                return Eigen::MatrixXd(stress(material, stretch.asDiagonal()));
            };
            P = stress_at(side);
            const double h = 1e-4;
            const double slope = (stress_at(side + h)(1, 1) - stress_at(side - h)(1, 1)) / (2 * h);
            side -= P(1, 1) / slope;
        }
        // Terms of order e^2 are left out of Hooke's law.
        EXPECT_NEAR(side / e, -poisson, 1e-5);
        EXPECT_NEAR(P(0, 0) / e, 1e5, 1);
    }
}

// A square beam of side b and length 4 b under its own weight at nu = 0, where nothing depends on z
// and w: one cell there is enough. Timoshenko with the second moment of a 4D beam, b^5 / 12, and
// shear coefficient 5/6 (of the rectangle at nu = 0).
double tip_deflection(int cells) {
    const double b = 0.5;
    const double length = 4 * b;
    Scene scene = box_scene<4>();
    scene.bodies[0].material = {
        .model = Model::Linear, .lame = lame_from_young(4, 1e6, 0), .density = 10};
    scene.gravity[1] = -1;
    scene.constraints = {hold(kLeftEnd, still(4))};
    scene.solver = {.integrator = Integrator::Quasistatic,
                    .precision = Precision::Double,
                    .tolerance = 1e-9,
                    .newton_tolerance = 1e-7};
    Simulation<4> simulation(
        scene, {pent::test::kuhn_box<4>({4 * cells, cells, 1, 1}, {length, b, b, b})});
    EXPECT_TRUE(simulation.step().is_accepted);
    double sum = 0;
    int count = 0;
    for (Eigen::Index v = 0; v < simulation.mesh(0).vertex_count(); ++v) {
        if (simulation.mesh(0).positions(0, v) > length - 1e-9) {
            sum += simulation.mesh(0).positions(1, v) - simulation.positions(0)(1, v);
            ++count;
        }
    }
    return sum / count;
}

TEST(BendingBeam, MeetsTimoshenkoTheoryByExtrapolationWithin3Percent) {
    const double b = 0.5;
    const double L = 4 * b;
    const double load = 10 * 1 * b * b * b;  // N per m of length
    const double bending = load * std::pow(L, 4) / (8 * 1e6 * std::pow(b, 5) / 12);
    const double shear = load * L * L / (2 * 5.0 / 6 * 0.5e6 * b * b * b);
    const double coarse = tip_deflection(2);
    const double middle = tip_deflection(4);
    const double fine = tip_deflection(8);
    EXPECT_LT(coarse, middle);  // linear simplices lock: too stiff, less so when finer
    EXPECT_LT(middle, fine);
    // Aitken: the error shrinks by the same factor at each halving.
    const double limit = fine - (fine - middle) * (fine - middle) / (fine - 2 * middle + coarse);
    EXPECT_NEAR(limit, bending + shear, 0.03 * (bending + shear));
}

Scene soft_bar(Integrator integrator, int steps_per_frame) {
    Scene scene = box_scene<4>();
    scene.bodies[0].material.lame = lame_from_young(4, 2e4, 0.28);
    scene.steps_per_frame = steps_per_frame;
    scene.solver = {.integrator = integrator,
                    .precision = Precision::Double,
                    .tolerance = 1e-11,
                    .newton_tolerance = 1e-9};
    return scene;
}

Positions<4> swing(Integrator integrator, int steps_per_frame) {
    Scene scene = soft_bar(integrator, steps_per_frame);
    scene.gravity[1] = -9.8;
    scene.constraints = {hold(kLeftEnd, still(4))};
    Simulation<4> simulation(scene, {pent::test::kuhn_box<4>({3, 1, 1, 1}, {0.9, 0.3, 0.3, 0.3})});
    for (int i = 0; i < 3 * steps_per_frame; ++i) {
        EXPECT_TRUE(simulation.step().is_accepted);
    }
    return simulation.positions(0);
}

// Observed order from three step sizes, each half the one before.
double observed_order(Integrator integrator) {
    const Positions<4> coarse = swing(integrator, 16);
    const Positions<4> middle = swing(integrator, 32);
    const Positions<4> fine = swing(integrator, 64);
    return std::log2((coarse - middle).norm() / (middle - fine).norm());
}

TEST(TimeStepping, IsFirstOrderWithEulerAndSecondWithBdf2) {
    // Leading terms dominate to about a tenth of an order at these steps.
    EXPECT_NEAR(observed_order(Integrator::LinearEuler), 1, 0.15);
    EXPECT_NEAR(observed_order(Integrator::NewtonEuler), 1, 0.15);
    EXPECT_NEAR(observed_order(Integrator::Bdf2), 2, 0.3);
}

Eigen::Matrix4d angular_momentum(const Simulation<4>& simulation) {
    const Eigen::Matrix4d moment = simulation.positions(0) * simulation.masses(0).asDiagonal()
                                   * simulation.velocities(0).transpose();
    return moment - moment.transpose();
}

// Largest relative loss over all six planes in half a second of a body that spins in all of them.
double lost_angular_momentum(Integrator integrator, int steps_per_frame) {
    const Scene scene = soft_bar(integrator, steps_per_frame);
    Simulation<4> simulation(scene, {pent::test::kuhn_box<4>({2, 1, 1, 1}, {0.6, 0.3, 0.3, 0.3})});
    Eigen::Matrix4d spin = Eigen::Matrix4d::Zero();
    spin(1, 0) = 0.8;
    spin(2, 0) = -1.1;
    spin(3, 0) = -1.5;
    spin(2, 1) = 2;
    spin(3, 1) = 0.6;
    spin(3, 2) = 1.2;
    spin -= spin.transpose().eval();
    const Positions<4> start = simulation.mesh(0).positions;
    const Eigen::Vector4d center = start * simulation.masses(0) / simulation.masses(0).sum();
    simulation.set_state(0, start, spin * (start.colwise() - center));
    const Eigen::Matrix4d before = angular_momentum(simulation);
    for (int i = 0; i < 15 * steps_per_frame; ++i) {
        EXPECT_TRUE(simulation.step().is_accepted);
    }
    double most = 0;
    for (int p = 0; p < 4; ++p) {
        for (int q = p + 1; q < 4; ++q) {
            const double lost = std::abs(angular_momentum(simulation)(p, q) - before(p, q));
            most = std::max(most, lost / std::abs(before(p, q)));
        }
    }
    return most;
}

TEST(AngularMomentum, DriftsAtFirstOrderWithEulerAndLessWithBdf2) {
    const double coarse = lost_angular_momentum(Integrator::NewtonEuler, 4);
    const double fine = lost_angular_momentum(Integrator::NewtonEuler, 8);
    EXPECT_NEAR(coarse / fine, 2, 0.3);
    EXPECT_LT(lost_angular_momentum(Integrator::Bdf2, 4), coarse / 5);
}

TEST(FlattenedBody, ReturnsToRest) {
    Scene scene = box_scene<4>();
    scene.solver.integrator = Integrator::NewtonEuler;
    scene.damping = Damping{.mass = 5, .stiffness = 0};
    Simulation<4> simulation(scene, {pent::test::kuhn_box<4>({2, 2, 2, 1}, {1, 1, 1, 0.5})});
    Positions<4> flat = simulation.mesh(0).positions;
    flat.row(3).setZero();
    simulation.set_state(0, flat, Positions<4>::Zero(4, flat.cols()));
    for (int i = 0; i < 90; ++i) {
        ASSERT_TRUE(simulation.step().is_accepted);
    }
    EXPECT_LT(
        non_rigid<4>(simulation.mesh(0).positions, simulation.positions(0), simulation.masses(0)),
        1e-3);
}

// Where the linear energy is exact, Newton's first step is, and all integrators share equilibria.
TEST(Quasistatic, EndsWhereADampedMotionComesToRest) {
    Scene scene = soft_bar(Integrator::Quasistatic, 1);
    scene.gravity[1] = -2;
    scene.constraints = {hold(kLeftEnd, still(4))};
    const SimplexMesh<4> mesh = pent::test::kuhn_box<4>({3, 1, 1, 1}, {0.9, 0.3, 0.3, 0.3});
    Simulation<4> at_once(scene, {mesh});
    ASSERT_TRUE(at_once.step().is_accepted);
    scene.solver.integrator = Integrator::NewtonEuler;
    // The slowest mode has 1.7 rad/s: nearly critical damping takes it down by exp(-20) in 400
    // steps.
    scene.damping = Damping{.mass = 3, .stiffness = 0};
    Simulation<4> slowly(scene, {mesh});
    for (int i = 0; i < 400; ++i) {
        ASSERT_TRUE(slowly.step().is_accepted);
    }
    const double moved = (at_once.positions(0) - mesh.positions).norm();
    EXPECT_LT((at_once.positions(0) - slowly.positions(0)).norm(), 1e-5 * moved);
    EXPECT_LT(at_once.forces(0).col(3).norm(), 1e-6);  // a free vertex in equilibrium
}

TEST(DirectSolver, TakesTheStepsOfConjugateGradients) {
    Scene scene = soft_bar(Integrator::NewtonEuler, 1);
    scene.gravity[1] = -9.8;
    scene.constraints = {hold(kLeftEnd, still(4))};
    const SimplexMesh<4> mesh = pent::test::kuhn_box<4>({3, 1, 1, 1}, {0.9, 0.3, 0.3, 0.3});
    Simulation<4> iterated(scene, {mesh});
    scene.solver.linear = LinearSolverKind::Direct;
    Simulation<4> direct(scene, {mesh});
    for (int i = 0; i < 10; ++i) {
        ASSERT_TRUE(iterated.step().is_accepted);
        const StepReport report = direct.step();
        ASSERT_TRUE(report.is_accepted);
        EXPECT_EQ(report.iterations, 0);
    }
    // Newton's method stops at 1e-9 of the unbalanced force.
    EXPECT_LT((iterated.positions(0) - direct.positions(0)).norm(), 1e-7);
}

TEST(DirectSolver, TakesTheStepsOfConjugateGradientsThroughContactToo) {
    Scene scene = test::two_cubes<3>(0.02);  // within the distance: the cubes push each other
    scene.solver.tolerance = 1e-10;
    const std::vector<SimplexMesh<3>> meshes(2, test::cube<3>());
    Simulation<3> iterated(scene, meshes);
    scene.solver.linear = LinearSolverKind::Direct;
    Simulation<3> direct(scene, meshes);
    ASSERT_TRUE(iterated.step().is_accepted);
    const StepReport report = direct.step();
    ASSERT_TRUE(report.is_accepted);
    EXPECT_GT(report.contact.point_facet, 0);
    const double moved = (direct.positions(1) - meshes[1].positions).norm();
    EXPECT_LT((iterated.positions(1) - direct.positions(1)).norm(), 1e-8 * moved);
}

TEST(Simulation, WantsAMeshForEveryBody) {
    pent::test::expect_contains(
        pent::test::error_of([] { Simulation<3>(test::two_cubes<3>(0.1), {test::cube<3>()}); }),
        {"the scene has 2 bodies", "got 1"});
}

TEST(NewtonEuler, EqualsLinearEulerForTheLinearEnergy) {
    Scene scene = soft_bar(Integrator::NewtonEuler, 1);
    scene.gravity[1] = -9.8;
    scene.bodies[0].material.model = Model::Linear;
    scene.constraints = {hold(kLeftEnd, still(4))};
    scene.damping = Damping{.mass = 0.3, .stiffness = 0.02};
    const SimplexMesh<4> mesh = pent::test::kuhn_box<4>({3, 1, 1, 1}, {0.9, 0.3, 0.3, 0.3});
    Simulation<4> newton(scene, {mesh});
    scene.solver.integrator = Integrator::LinearEuler;
    Simulation<4> linear(scene, {mesh});
    for (int i = 0; i < 10; ++i) {
        ASSERT_TRUE(newton.step().is_accepted);
        ASSERT_TRUE(linear.step().is_accepted);
    }
    EXPECT_LT((newton.positions(0) - linear.positions(0)).norm(), 1e-7);
}

}  // namespace
}  // namespace pent::simulator
