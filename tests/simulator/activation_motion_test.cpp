#include "muscle.h"
#include "potential_laws.h"

#include <pent/simulator/simulation.h>

#include <gtest/gtest.h>

#include <cmath>

// Muscles and growth in motion.

namespace pent::simulator {
namespace {

using test::cube;
using test::momentum;

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;

template <typename T>
class ActivationMotion : public testing::Test {};
TYPED_TEST_SUITE(ActivationMotion, Dimensions);

template <int Dim>
Scene muscle_scene(double stretch) {
    Scene scene = test::box_scene<Dim>();
    scene.solver.precision = Precision::Double;
    scene.solver.tolerance = 1e-10;
    scene.solver.newton_tolerance = 1e-8;
    scene.activations = {test::muscle(stretch, Eigen::VectorXd::Unit(Dim, 0))};
    return scene;
}

// How far a body is from the shape S X, X at rest, wherever that is and however it is turned: the
// largest error of a distance between two vertices, m.
template <int Dim>
double distance_from(const Simulation<Dim>& simulation, const Eigen::Matrix<double, Dim, Dim>& S) {
    const auto x = simulation.positions(0);
    const Positions<Dim> wanted = S * simulation.mesh(0).positions;
    double largest = 0;
    for (Eigen::Index a = 0; a < x.cols(); ++a) {
        for (Eigen::Index b = 0; b < a; ++b) {
            const double error =
                (x.col(a) - x.col(b)).norm() - (wanted.col(a) - wanted.col(b)).norm();
            largest = std::max(largest, std::abs(error));
        }
    }
    return largest;
}

// Slow against the slowest vibration and damped, a free bar is where it has no stress at all.
TYPED_TEST(ActivationMotion, SlowAndUnloadedReachesTheExactShape) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind : {ElementKind::Linear, ElementKind::Quadratic}) {
        for (const Integrator integrator :
             {Integrator::LinearEuler, Integrator::NewtonEuler, Integrator::Bdf2}) {
            Scene scene = muscle_scene<kDim>(0.7);
            scene.solver.elements = kind;
            scene.solver.integrator = integrator;
            scene.frames_per_second = 50;
            scene.damping = Damping{.mass = 20, .stiffness = 0};
            scene.activations[0].preserves_volume = true;
            scene.activations[0].keyframes = {{0, 0}, {1, 1}};
            Simulation<kDim> simulation(scene, {test::cube_for<kDim>(scene, 2)});
            for (int i = 0; i < 75; ++i) {
                ASSERT_TRUE(simulation.step().is_accepted);
            }
            Eigen::Matrix<double, kDim, kDim> shape =
                std::pow(0.7, -1.0 / (kDim - 1)) * Eigen::Matrix<double, kDim, kDim>::Identity();
            shape(0, 0) = 0.7;
            EXPECT_LT(distance_from<kDim>(simulation, shape), 5e-5) << static_cast<int>(integrator);
        }
    }
}

// Inner forces: what swims in nothing goes nowhere. Implicit steps keep the momentum, and the
// angular momentum to the order of their error, which halves with the step.
TYPED_TEST(ActivationMotion, KeepsTheMomentum) {
    constexpr int kDim = TypeParam::value;
    Scene scene = muscle_scene<kDim>(0.6);
    scene.solver.integrator = Integrator::NewtonEuler;
    scene.activations[0].signal = Signal::Sine;
    scene.activations[0].wave = Eigen::VectorXd::Constant(kDim, 1.1);
    scene.activations[0].frequency = 3;
    Simulation<kDim> simulation(scene, {cube<kDim>(2)});
    double speed = 0;
    for (int i = 0; i < 20; ++i) {
        ASSERT_TRUE(simulation.step().is_accepted);
        speed = std::max(speed, simulation.velocities(0).cwiseAbs().maxCoeff());
    }
    EXPECT_GT(speed, 0.1);
    EXPECT_LT(momentum(simulation).norm(), 1e-9 * speed * simulation.masses(0).sum());
}

// A bar held at both ends that wants to be shorter: nothing moves out of balance, so that all work
// of the muscle is in the elastic energy. The rule for the work is of second order in the step.
TYPED_TEST(ActivationMotion, DoesTheWorkThatTheEnergyGrowsBy) {
    constexpr int kDim = TypeParam::value;
    const auto difference = [](int steps) {
        Scene scene = muscle_scene<kDim>(0.8);
        scene.solver.integrator = Integrator::Quasistatic;
        scene.frames_per_second = steps;
        scene.activations[0].keyframes = {{0, 0}, {1, 1}};
        for (const double side : {-1.0, 1.0}) {
            const Eigen::VectorXd normal = side * Eigen::VectorXd::Unit(kDim, 0);
            scene.constraints.push_back(test::hold(
                HalfSpaceSelection{normal, side > 0 ? 1e-9 : -0.5 + 1e-9}, test::still(kDim)));
        }
        Simulation<kDim> simulation(scene, {cube<kDim>(2)});
        double work = 0;
        for (int i = 0; i < steps; ++i) {
            const StepReport report = simulation.step();
            EXPECT_TRUE(report.is_accepted);
            work += report.activation_work;
        }
        const double energy = simulation.energies().of("elastic");
        EXPECT_GT(energy, 1);
        return std::abs(work - energy) / energy;
    };
    const double coarse = difference(5);
    const double fine = difference(10);
    EXPECT_LT(coarse, 0.05);
    EXPECT_LT(fine, coarse / 3);
}

TYPED_TEST(ActivationMotion, WakesASleeperWhenItBeginsAndLetsItSleepBefore) {
    constexpr int kDim = TypeParam::value;
    Scene scene = muscle_scene<kDim>(0.7);
    scene.solver.integrator = Integrator::NewtonEuler;
    scene.sleep = Sleep{.speed = 1e-3, .time = 0.1};
    scene.activations[0].keyframes = {{0.5, 0}, {0.7, 1}};
    Simulation<kDim> simulation(scene, {cube<kDim>(1)});
    int slept = 0;
    while (simulation.time() < 0.45) {
        slept += simulation.step().asleep;
    }
    EXPECT_GT(slept, 3);
    while (simulation.time() < 0.6) {
        static_cast<void>(simulation.step());
    }
    EXPECT_FALSE(simulation.sleep()[0].is_asleep);
    EXPECT_GT(distance_from<kDim>(simulation, Eigen::Matrix<double, kDim, kDim>::Identity()), 0.01);
}

// A body sleeps in the shape that a muscle keeps it in, with the forces of that.
TYPED_TEST(ActivationMotion, SleepsInTheActivatedShape) {
    constexpr int kDim = TypeParam::value;
    Scene scene = muscle_scene<kDim>(0.7);
    scene.solver.integrator = Integrator::NewtonEuler;
    scene.damping = Damping{.mass = 30, .stiffness = 0};
    scene.sleep = Sleep{.speed = 1e-3, .time = 0.1};
    Simulation<kDim> simulation(scene, {cube<kDim>(1)});
    for (int i = 0; i < 120; ++i) {
        static_cast<void>(simulation.step());
    }
    ASSERT_TRUE(simulation.sleep()[0].is_asleep);
    Eigen::Matrix<double, kDim, kDim> shape = Eigen::Matrix<double, kDim, kDim>::Identity();
    shape(0, 0) = 0.7;
    EXPECT_LT(distance_from<kDim>(simulation, shape), 1e-3);
    EXPECT_LT(simulation.energies().of("elastic"), 0.05);
}

TYPED_TEST(ActivationMotion, GoesOnToTheSameBitsFromASnapshotAndWithAnyThreads) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind : {ElementKind::Linear, ElementKind::Quadratic}) {
        Scene scene = muscle_scene<kDim>(0.6);
        scene.solver.elements = kind;
        scene.solver.integrator = Integrator::Bdf2;
        scene.activations[0].signal = Signal::Pulses;
        scene.activations[0].frequency = 4;
        scene.activations[0].wave = Eigen::VectorXd::Constant(kDim, 1.1);
        const auto make = [&](int threads) {
            return Simulation<kDim>(scene, {test::cube_for<kDim>(scene, 3)}, {.threads = threads});
        };
        Simulation<kDim> whole = make(1);
        Simulation<kDim> other = make(3);
        Simulation<kDim> resumed = make(2);
        for (int i = 0; i < 6; ++i) {
            const double work = whole.step().activation_work;
            EXPECT_EQ(other.step().activation_work, work);
            if (i == 2) {
                resumed.restore(whole.save());
            }
            if (i > 2) {
                EXPECT_EQ(resumed.step().activation_work, work);
            }
        }
        EXPECT_EQ(whole.positions(0), other.positions(0));
        EXPECT_EQ(whole.positions(0), resumed.positions(0));
        EXPECT_EQ(whole.forces(0), resumed.forces(0));
    }
}

}  // namespace
}  // namespace pent::simulator
