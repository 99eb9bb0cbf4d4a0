#include "contact_scenes.h"
#include "muscle.h"
#include "potential_laws.h"

#include <pent/simulator/energy.h>

#include <gtest/gtest.h>

#include <cmath>

// Elements whose corners are all held: nothing is solved for, but they are strained, and what holds
// them feels it.

namespace pent::simulator {
namespace {

template <typename T>
class HeldElements : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(HeldElements, Dimensions);

constexpr double kSide = 0.5;  // of a cube with vertices at x = 0, half and all of it, m

// What is near one x, carried along x.
template <int Dim>
Constraint plane_at(double x, double speed) {
    Eigen::VectorXd low = Eigen::VectorXd::Constant(Dim, -1);
    Eigen::VectorXd high = Eigen::VectorXd::Constant(Dim, 1);
    low[0] = x - 1e-6;
    high[0] = x + 1e-6;
    Constraint constraint = test::hold(BoxSelection{.low = low, .high = high}, test::still(Dim));
    constraint.motion[0].translate[0] = speed;
    return constraint;
}

// Energy and forces are those of the material, by hand: all is stretched alike along x.
TYPED_TEST(HeldElements, HoldBackByTheStressOfTheirStretch) {
    constexpr int kDim = TypeParam::value;
    constexpr double kSpeed = 0.6;
    for (const ElementKind kind :
         {ElementKind::Linear, ElementKind::Smoothed, ElementKind::Quadratic}) {
        Scene scene = test::box_scene<kDim>();
        scene.solver.elements = kind;
        scene.constraints = {plane_at<kDim>(0, 0), plane_at<kDim>(kSide / 2, kSpeed / 2),
                             plane_at<kDim>(kSide, kSpeed)};
        Simulation<kDim> simulation(scene, {test::cube_for<kDim>(scene, 2)}, {.threads = 2});
        EXPECT_EQ(simulation.size().free_vertices, 0);
        for (int step = 0; step < 3; ++step) {
            const StepReport report = simulation.step();
            ASSERT_TRUE(report.is_accepted) << report.failure;
            Eigen::MatrixXd F = Eigen::MatrixXd::Identity(kDim, kDim);
            F(0, 0) += kSpeed * report.time / kSide;
            const Material& material = scene.bodies[0].material;
            const double energy = std::pow(kSide, kDim) * energy_density(material, F);
            const double force = std::pow(kSide, kDim - 1) * stress(material, F)(0, 0);
            EXPECT_NEAR(report.energies.of("elastic"), energy, 1e-10 * energy);
            EXPECT_NEAR(report.constraints[0].force[0], -force, 1e-10 * force);
            EXPECT_NEAR(report.constraints[1].force[0], 0, 1e-10 * force);
            EXPECT_NEAR(report.constraints[2].force[0], force, 1e-10 * force);
            EXPECT_EQ(report.inverted, 0);
        }
    }
}

// A constraint has one side from the start, a host all else, which moves with nothing.
TYPED_TEST(HeldElements, HoldBackAHostToo) {
    constexpr int kDim = TypeParam::value;
    constexpr double kStretch = 1.2;
    for (const ElementKind kind :
         {ElementKind::Linear, ElementKind::Smoothed, ElementKind::Quadratic}) {
        Scene scene = test::box_scene<kDim>();
        scene.solver.elements = kind;
        scene.constraints = {plane_at<kDim>(0, 0)};
        Simulation<kDim> simulation(scene, {test::cube_for<kDim>(scene, 2)}, {.threads = 2});
        Positions<kDim> x = simulation.positions(0);
        x.row(0) *= kStretch;
        std::vector<std::uint32_t> others;
        std::vector<std::uint32_t> far;
        for (std::uint32_t vertex = 0; vertex < x.cols(); ++vertex) {
            if (x(0, vertex) > 0) {
                others.push_back(vertex);
            }
            if (x(0, vertex) > 0.9 * kStretch * kSide) {
                far.push_back(vertex);
            }
        }
        simulation.set_targets(0, others, x(Eigen::all, others));
        const StepReport report = simulation.step();
        ASSERT_TRUE(report.is_accepted) << report.failure;
        Eigen::MatrixXd F = Eigen::MatrixXd::Identity(kDim, kDim);
        F(0, 0) = kStretch;
        const Material& material = scene.bodies[0].material;
        const double energy = std::pow(kSide, kDim) * energy_density(material, F);
        const double force = std::pow(kSide, kDim - 1) * stress(material, F)(0, 0);
        EXPECT_NEAR(report.energies.of("elastic"), energy, 1e-10 * energy);
        EXPECT_NEAR(report.constraints[0].force[0], -force, 1e-10 * force);
        const Positions<kDim> pulls = simulation.forces(0);
        EXPECT_NEAR(pulls(0, far).sum(), -force, 1e-10 * force);
        // Nothing is left of it where the host lets go.
        simulation.release(0, others);
        EXPECT_NEAR(simulation.energies().of("elastic"), energy, 1e-10 * energy);
        EXPECT_LT((simulation.forces(0) - pulls).norm(), 1e-12 * force);
    }
}

// Of a body that is grabbed as a whole while it swings, and let go.
TYPED_TEST(HeldElements, KeepEnergyAndForcesWhenAGripBeginsAndEnds) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind :
         {ElementKind::Linear, ElementKind::Smoothed, ElementKind::Quadratic}) {
        Scene scene = test::box_scene<kDim>();
        scene.solver.elements = kind;
        scene.solver.integrator = Integrator::NewtonEuler;
        scene.frames_per_second = 100;
        Constraint grab = test::hold(EverythingSelection{}, test::still(kDim));
        grab.from = 0.03;
        grab.to = 0.06;
        scene.constraints = {grab};
        Simulation<kDim> simulation(scene, {test::cube_for<kDim>(scene, 2)});
        Positions<kDim> x = simulation.positions(0);
        x.row(0) *= 1.2;
        simulation.set_state(0, x, Positions<kDim>::Zero(kDim, x.cols()));
        double energy = 0;
        Positions<kDim> forces;
        for (int step = 0; step < 6; ++step) {
            const StepReport report = simulation.step();
            ASSERT_TRUE(report.is_accepted) << report.failure;
            if (step < 3) {
                energy = report.energies.of("elastic");
                forces = simulation.forces(0);
                EXPECT_GT(energy, 0);
                continue;
            }
            EXPECT_NEAR(report.energies.of("elastic"), energy, 1e-12 * energy);
            EXPECT_LT((simulation.forces(0) - forces).norm(), 1e-12 * forces.norm());
            EXPECT_LT((simulation.vertex_values(VertexQuantity::Reaction, 0) + forces).norm(),
                      1e-12 * forces.norm());
        }
        const StepReport free = simulation.step();
        ASSERT_TRUE(free.is_accepted) << free.failure;
        EXPECT_LT(free.energies.of("elastic"), energy);
        EXPECT_LT(free.energies.of("elastic") + free.energies.kinetic, energy);  // Euler's loss
    }
}

// A muscle in the middle of what one constraint holds: det Fa V Psi(Fa^-1), all of it its work.
TYPED_TEST(HeldElements, HaveTheWorkOfTheirActivations) {
    constexpr int kDim = TypeParam::value;
    constexpr double kStretch = 0.7;
    for (const ElementKind kind : {ElementKind::Linear, ElementKind::Quadratic}) {
        Scene scene = test::box_scene<kDim>();
        scene.solver.elements = kind;
        scene.frames_per_second = 10;
        scene.activations = {test::muscle(kStretch, Eigen::VectorXd::Unit(kDim, 0))};
        scene.activations[0].keyframes = {{0, 0}, {0.3, 1}};
        scene.constraints = {test::hold(EverythingSelection{}, test::still(kDim))};
        Simulation<kDim> simulation(scene, {test::cube_for<kDim>(scene, 2)});
        double before = simulation.energies().of("elastic");
        EXPECT_LT(before, 1e-20);
        for (int step = 0; step < 4; ++step) {
            const StepReport report = simulation.step();
            ASSERT_TRUE(report.is_accepted) << report.failure;
            const double energy = report.energies.of("elastic");
            EXPECT_NEAR(report.activation_work, energy - before, 1e-10 * energy) << step;
            before = energy;
        }
        Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(kDim, kDim);
        inverse(0, 0) = 1 / kStretch;
        const double energy =
            kStretch * std::pow(kSide, kDim) * energy_density(scene.bodies[0].material, inverse);
        EXPECT_NEAR(before, energy, 1e-10 * energy);
    }
}

// Linear elasticity takes a turn for a strain: energy and forces are those of F = R, by hand.
TYPED_TEST(HeldElements, AreStrainedByATurnWhereTheyAreLinear) {
    constexpr int kDim = TypeParam::value;
    constexpr double kAngle = 0.4;
    Motion spinning = test::still(kDim);
    spinning.rotate = {{.plane = {0, kDim - 1}, .degrees_per_s = kAngle * 180 / M_PI}};
    Motion keyframed = test::still(kDim);
    MotionKeyframe& end = keyframed.keyframes.emplace_back();
    end.time = 1;
    end.translate = Eigen::VectorXd::Zero(kDim);
    end.rotate = {{.plane = {0, kDim - 1}, .degrees = kAngle * 180 / M_PI}};
    for (const Motion& motion : {spinning, keyframed}) {
        for (const ElementKind kind :
             {ElementKind::Linear, ElementKind::Smoothed, ElementKind::Quadratic}) {
            Scene scene = test::box_scene<kDim>();
            scene.solver.elements = kind;
            scene.frames_per_second = 2;
            scene.bodies[0].material.model = Model::Linear;
            scene.constraints = {test::hold(EverythingSelection{}, motion)};
            Simulation<kDim> simulation(scene, {test::cube_for<kDim>(scene, 2)});
            std::vector<std::uint32_t> far;
            for (std::uint32_t vertex = 0; vertex < simulation.masses(0).size(); ++vertex) {
                if (simulation.positions(0)(0, vertex) > 0.9 * kSide) {
                    far.push_back(vertex);
                }
            }
            StepReport report = simulation.step();
            report = simulation.step();
            ASSERT_TRUE(report.is_accepted) << report.failure;
            Eigen::MatrixXd F = Eigen::MatrixXd::Identity(kDim, kDim);
            F(0, 0) = F(kDim - 1, kDim - 1) = std::cos(kAngle);
            F(kDim - 1, 0) = std::sin(kAngle);
            F(0, kDim - 1) = -F(kDim - 1, 0);
            const Material& material = scene.bodies[0].material;
            const double energy = std::pow(kSide, kDim) * energy_density(material, F);
            const Eigen::VectorXd force =
                std::pow(kSide, kDim - 1) * Eigen::MatrixXd(stress(material, F)).col(0);
            EXPECT_GT(energy, 0);
            EXPECT_NEAR(report.energies.of("elastic"), energy, 1e-10 * energy);
            const Positions<kDim> reactions = simulation.vertex_values(VertexQuantity::Reaction, 0);
            EXPECT_LT((reactions(Eigen::all, far).rowwise().sum() - force).norm(),
                      1e-10 * force.norm());
        }
    }
}

// They are not even looked at: not the least energy by rounding.
TYPED_TEST(HeldElements, CostNothingWhereOneGripHasAll) {
    constexpr int kDim = TypeParam::value;
    Scene scene = test::box_scene<kDim>();
    Motion turning = test::still(kDim);
    turning.rotate = {{.plane = {0, kDim - 1}, .degrees_per_s = 100}};
    scene.constraints = {test::hold(EverythingSelection{}, turning)};
    Simulation<kDim> simulation(scene, {test::cube<kDim>()});
    const StepReport report = simulation.step();
    ASSERT_TRUE(report.is_accepted) << report.failure;
    EXPECT_EQ(report.energies.of("elastic"), 0);
    EXPECT_EQ(simulation.forces(0).norm(), 0);
}

}  // namespace
}  // namespace pent::simulator
