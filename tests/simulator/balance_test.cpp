#include "step/balance.h"

#include "contact_scenes.h"

#include <gtest/gtest.h>

#include <random>

// What a step says of forces and momenta as a whole.

namespace pent::simulator {
namespace {

using test::cube;

template <typename T>
class Balance : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(Balance, Dimensions);

// Two masses, by hand.
TEST(AngularMomentum, IsAboutTheOriginAndHasAPlaneForEachPairOfAxes) {
    Positions<4> x(4, 2);
    Positions<4> v(4, 2);
    x.col(0) = Eigen::Vector4d(2, 0, 0, 0);
    v.col(0) = Eigen::Vector4d(0, 3, 0, 0);  // x ^ v: 6 in xy
    x.col(1) = Eigen::Vector4d(0, 0, 1, 5);
    v.col(1) = Eigen::Vector4d(0, 0, 0, 7);  // 7 in zw
    const Eigen::VectorXd masses = Eigen::Vector2d(10, 100);
    EXPECT_EQ(angular_momentum<4>(masses, x, v), (std::vector<double>{60, 0, 0, 0, 0, 700}));
    EXPECT_EQ(momentum<4>(masses, v), (std::vector<double>{0, 30, 0, 700}));
}

// A body that nothing holds flies on: its momentum stays, and its angular momentum to the first
// order of backward Euler, of which a second step of half the length loses half as much.
TYPED_TEST(Balance, IsOfTheStateAtTheEndOfAStep) {
    constexpr int kDim = TypeParam::value;
    const auto lost = [](int steps_per_frame) {
        Scene scene = test::box_scene<kDim>();
        scene.output.balance = true;
        scene.steps_per_frame = steps_per_frame;
        scene.solver.integrator = Integrator::NewtonEuler;
        scene.solver.precision = Precision::Double;
        scene.solver.tolerance = scene.solver.newton_tolerance = 1e-10;
        scene.bodies[0].velocity = Eigen::VectorXd::Constant(kDim, 0.3);
        scene.bodies[0].spin = {{{0, 1}, 90}};
        Simulation<kDim> simulation(scene, {cube<kDim>()});
        const Eigen::VectorXd masses = simulation.masses(0);
        const double before =
            angular_momentum<kDim>(masses, simulation.positions(0), simulation.velocities(0))[0];
        StepReport report;
        for (int i = 0; i < 4 * steps_per_frame; ++i) {
            report = simulation.step();
            EXPECT_TRUE(report.is_accepted);
        }
        for (const double part : report.momentum) {
            EXPECT_NEAR(part, 0.3 * masses.sum(), 1e-8 * masses.sum());
        }
        EXPECT_EQ(report.angular_momentum, angular_momentum<kDim>(masses, simulation.positions(0),
                                                                  simulation.velocities(0)));
        return (before - report.angular_momentum[0]) / before;
    };
    const double whole = lost(1);
    EXPECT_GT(whole, 0);
    EXPECT_NEAR(lost(2) / whole, 0.5, 0.1);
    Scene scene = test::box_scene<kDim>();
    EXPECT_TRUE(Simulation<kDim>(scene, {cube<kDim>()}).step().momentum.empty());
}

// In equilibrium a support holds the weight, and its moment that of the weight about its middle.
TYPED_TEST(Balance, HasInEquilibriumTheForceAndMomentOfTheWeight) {
    constexpr int kDim = TypeParam::value;
    Scene scene = test::box_scene<kDim>();
    scene.gravity = Eigen::VectorXd::LinSpaced(kDim, -9.8, 3);
    scene.solver.integrator = Integrator::Quasistatic;
    scene.solver.precision = Precision::Double;
    scene.solver.tolerance = scene.solver.newton_tolerance = 1e-10;
    const auto side = [](double sign, double offset) {
        return test::hold(
            HalfSpaceSelection{.normal = sign * Eigen::VectorXd::Unit(kDim, 0), .offset = offset},
            test::still(kDim));
    };
    scene.constraints = {side(1, 1e-6), side(-1, -0.5 + 1e-6)};
    Simulation<kDim> simulation(scene, {cube<kDim>()});
    const StepReport report = simulation.step();
    ASSERT_TRUE(report.is_accepted) << report.failure;
    ASSERT_EQ(report.constraints.size(), 2);
    const Positions<kDim> x = simulation.positions(0);
    const Eigen::VectorXd masses = simulation.masses(0);
    Vector<kDim> force = Vector<kDim>::Zero();
    std::vector<double> moment(kDim * (kDim - 1) / 2);
    for (const ConstraintSummary& one : report.constraints) {
        EXPECT_EQ(one.held, kDim == 3 ? 9 : 27);
        // About the origin: its own, and that of its force at its center.
        std::size_t plane = 0;
        for (std::size_t i = 0; i < kDim; ++i) {
            force[static_cast<Eigen::Index>(i)] += one.force[i];
            for (std::size_t j = i + 1; j < kDim; ++j, ++plane) {
                moment[plane] +=
                    one.moment[plane] + one.center[i] * one.force[j] - one.center[j] * one.force[i];
            }
        }
    }
    const double weight = masses.sum() * scene.gravity.norm();
    EXPECT_LT((force + masses.sum() * scene.gravity).norm(), 1e-8 * weight);
    const Vector<kDim> middle = x * masses / masses.sum();
    std::size_t plane = 0;
    for (int i = 0; i < kDim; ++i) {
        for (int j = i + 1; j < kDim; ++j, ++plane) {
            const double of_weight =
                masses.sum() * (middle[i] * scene.gravity[j] - middle[j] * scene.gravity[i]);
            EXPECT_NEAR(moment[plane], -of_weight, 1e-8 * weight);
        }
    }
}

// From 20 ms on, for 20 ms.
TEST(ConstraintSummaries, SayWhatIsHeldNow) {
    Scene scene = test::box_scene<3>();
    scene.frames_per_second = 100;
    scene.gravity[1] = -9.8;
    scene.constraints = {test::hold(
        HalfSpaceSelection{.normal = Eigen::Vector3d::UnitX(), .offset = 1e-6}, test::still(3))};
    scene.constraints[0].from = 0.02;
    scene.constraints[0].to = 0.04;
    Simulation<3> simulation(scene, {cube<3>()});
    for (int i = 0; i < 6; ++i) {
        const StepReport report = simulation.step();
        const bool is_held = i == 2 || i == 3;
        EXPECT_EQ(report.constraints[0].held, is_held ? 9 : 0);
        EXPECT_EQ(report.constraints[0].force[1] > 0, is_held);
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        for (Eigen::Index v = 0; v < simulation.mesh(0).vertex_count(); ++v) {
            middle += simulation.mesh(0).positions(0, v) < 1e-6
                          ? Eigen::Vector3d(simulation.positions(0).col(v) / 9)
                          : Eigen::Vector3d::Zero();
        }
        EXPECT_NEAR(report.constraints[0].center[1], middle[1], 1e-14);
    }
}

}  // namespace
}  // namespace pent::simulator
