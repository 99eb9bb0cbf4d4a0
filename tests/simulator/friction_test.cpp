#include "barrier_scenes.h"
#include "support/cut_in_two.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>

namespace pent::simulator {
namespace {

using test::BarrierScene;
using test::box;
using test::vector;

constexpr double kFriction = 0.4;
constexpr double kGravity = 9.8;

// A block on a half-space, gravity turned instead of the ground: down the slope is the first axis.
template <int Dim>
BarrierScene<Dim> slope(ContactModel model,
                        double tangent,
                        ElementKind elements = ElementKind::Linear) {
    BarrierScene<Dim> scene;
    scene.scene.solver.elements = elements;
    const double angle = std::atan(tangent);
    scene.scene.gravity = vector<Dim>(kGravity * std::sin(angle), -kGravity * std::cos(angle));
    scene.scene.contact->model = model;
    scene.scene.contact->friction = kFriction;
    scene.scene.frames_per_second = 50;
    scene.scene.obstacles.push_back({.shape = HalfSpaceObstacle{.normal = vector<Dim>(0, 1)},
                                     .distance = 0.02,
                                     .stiffness = 2e4});
    scene.scene.contact->stiffness = 2e4;
    // Flat and stiff, so that it neither topples nor bounces for long; damped for the same reason.
    scene.scene.damping = Damping{.mass = 0, .stiffness = 0.01};
    // Starts where the penalty of its lower corners balances its weight.
    const Eigen::VectorXd size = vector<Dim>(0.3, 0.1, 0.3);
    const bool is_quadratic = elements == ElementKind::Quadratic;
    const double corners = std::pow(is_quadratic ? 3 : 2, Dim - 1);
    const double depth = 1000 * size.prod() * kGravity * std::cos(angle) / (2 * 2e4 * corners);
    const SimplexMesh<Dim> block = box<Dim>(1, 1, 1, size);
    scene.add(is_quadratic ? pent::test::cut_in_two<Dim>(block) : block,
              vector<Dim>(0, 0.07 - depth), 1e6);
    return scene;
}

// How fast it is along the slope after 2 s. Two per cent off the angle what it gains or loses is a
// small part of g, 0.07 m/s^2, so it takes time to stop what settling has set in motion.
template <int Dim>
double speed_on(ContactModel model, double tangent, ElementKind elements = ElementKind::Linear) {
    const BarrierScene<Dim> scene = slope<Dim>(model, tangent, elements);
    Simulation<Dim> simulation(scene.scene, scene.meshes);
    for (int k = 0; k < 100; ++k) {
        EXPECT_TRUE(simulation.step().is_accepted);
    }
    return simulation.velocities(0).row(0).mean();
}

template <typename T>
class FrictionSlopeTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(FrictionSlopeTest, Dimensions);

TYPED_TEST(FrictionSlopeTest, BlockSticksBelowItsFrictionAngleAndSlidesAbove) {
    constexpr int kDim = TypeParam::value;
    for (const ContactModel model : {ContactModel::Penalty, ContactModel::Barrier}) {
        // What sticks creeps at less than the slip speed, 1e-3 m/s.
        EXPECT_LT(speed_on<kDim>(model, 0.98 * kFriction), 1e-3);
        EXPECT_GT(speed_on<kDim>(model, 1.02 * kFriction), 0.1);
    }
}

template <int Dim>
void expect_acceleration_of_coulomb(ContactModel model, ElementKind elements) {
    const double tangent = 2 * kFriction;
    const double angle = std::atan(tangent);
    const double expected = kGravity * (std::sin(angle) - kFriction * std::cos(angle));
    const BarrierScene<Dim> scene = slope<Dim>(model, tangent, elements);
    Simulation<Dim> simulation(scene.scene, scene.meshes);
    double speed = 0;
    for (int k = 0; k < 30; ++k) {
        EXPECT_TRUE(simulation.step().is_accepted);
        if (k == 14) {
            speed = simulation.velocities(0).row(0).mean();
        }
    }
    const double acceleration = (simulation.velocities(0).row(0).mean() - speed) / (15 * 0.02);
    EXPECT_NEAR(acceleration, expected, 0.02 * expected);
}

TYPED_TEST(FrictionSlopeTest, BlockSlidesWithTheAccelerationOfCoulombsLaw) {
    for (const ContactModel model : {ContactModel::Penalty, ContactModel::Barrier}) {
        expect_acceleration_of_coulomb<TypeParam::value>(model, ElementKind::Linear);
    }
}

// Their children's vertices are what rests and slides.
TYPED_TEST(FrictionSlopeTest, BlockOfQuadraticElementsSticksAndSlidesAsWell) {
    constexpr int kDim = TypeParam::value;
    for (const ContactModel model : {ContactModel::Penalty, ContactModel::Barrier}) {
        EXPECT_LT(speed_on<kDim>(model, 0.98 * kFriction, ElementKind::Quadratic), 1e-3);
        expect_acceleration_of_coulomb<kDim>(model, ElementKind::Quadratic);
    }
}

TYPED_TEST(FrictionSlopeTest, EnergyIsOnlyLost) {
    constexpr int kDim = TypeParam::value;
    for (const ContactModel model : {ContactModel::Penalty, ContactModel::Barrier}) {
        BarrierScene<kDim> scene = slope<kDim>(model, 0);
        scene.scene.bodies[0].velocity = vector<kDim>(0.7, 0, 0.3);
        Simulation<kDim> simulation(scene.scene, scene.meshes);
        double last = simulation.energies().total();
        const double first = simulation.energies().kinetic;
        for (int k = 0; k < 25; ++k) {
            EXPECT_TRUE(simulation.step().is_accepted);
            const double now = simulation.energies().total();
            EXPECT_LE(now, last + 1e-4 * first);  // what Newton's method leaves unbalanced
            last = now;
        }
        EXPECT_LT(simulation.energies().kinetic, 0.5 * first);
    }
}

// The same block on a soft slab that is held from below, in place of the half-space.
template <int Dim>
double speed_on_slab(double tangent) {
    BarrierScene<Dim> scene = slope<Dim>(ContactModel::Barrier, tangent);
    scene.scene.obstacles.clear();
    scene.scene.bodies[0].place.translate[1] = 0.067;
    const Eigen::VectorXd everywhere = vector<Dim>(9, 9, 9);
    scene.add(box<Dim>(2, 1, 1, vector<Dim>(1.2, 0.1, 0.5)), vector<Dim>(0.3, -0.05), 1e6);
    scene.hold(-everywhere, vector<Dim>(9, -0.09, 9), vector<Dim>(0, 0));
    Simulation<Dim> simulation(scene.scene, scene.meshes);
    for (int k = 0; k < 60; ++k) {
        EXPECT_TRUE(simulation.step().is_accepted);
    }
    return simulation.velocities(0).row(0).mean();
}

TYPED_TEST(FrictionSlopeTest, BlockOnAnotherBodySticksAndSlidesAsWell) {
    constexpr int kDim = TypeParam::value;
    // The slab gives way a little, so that its top is not quite the plane that the angle is of.
    EXPECT_LT(std::abs(speed_on_slab<kDim>(0.9 * kFriction)), 2e-3);
    EXPECT_GT(speed_on_slab<kDim>(1.15 * kFriction), 0.1);
}

TYPED_TEST(FrictionSlopeTest, SingleLinearSolvesHaveItToo) {
    constexpr int kDim = TypeParam::value;
    const auto speed_after = [](double friction) {
        BarrierScene<kDim> scene = slope<kDim>(ContactModel::Penalty, 0);
        scene.scene.solver.integrator = Integrator::LinearEuler;
        scene.scene.contact->friction = friction;
        scene.scene.bodies[0].velocity = vector<kDim>(1.5, 0);
        Simulation<kDim> simulation(scene.scene, scene.meshes);
        for (int k = 0; k < 10; ++k) {
            EXPECT_TRUE(simulation.step().is_accepted);
        }
        return simulation.velocities(0).row(0).mean();
    };
    EXPECT_GT(speed_after(0), 1.4);
    // 0.2 s of mu g: 0.78 m/s lost, to the settling of the block.
    EXPECT_NEAR(speed_after(kFriction), 1.5 - 0.2 * kFriction * kGravity, 0.15);
}

// As with settings of contact that say nothing of friction.
TYPED_TEST(FrictionSlopeTest, BodyAndObstacleWithCoefficientsOfTheirOwnNeedNoSettingsOfContact) {
    constexpr int kDim = TypeParam::value;
    const auto velocities_with = [](const std::optional<ContactSettings>& contact) {
        BarrierScene<kDim> scene = slope<kDim>(ContactModel::Penalty, 0);
        scene.scene.contact = contact;
        scene.scene.bodies[0].friction = kFriction;
        scene.scene.bodies[0].velocity = vector<kDim>(1.5, 0);
        scene.scene.obstacles[0].friction = kFriction;
        Simulation<kDim> simulation(scene.scene, scene.meshes);
        for (int k = 0; k < 10; ++k) {
            EXPECT_TRUE(simulation.step().is_accepted);
        }
        return Positions<kDim>(simulation.velocities(0));
    };
    const Positions<kDim> without = velocities_with(std::nullopt);
    EXPECT_EQ(without, velocities_with(ContactSettings{}));
    EXPECT_NEAR(without.row(0).mean(), 1.5 - 0.2 * kFriction * kGravity, 0.15);
}

// A soft block without damping that slides just off the angle keeps ringing for seconds: that is
// what an undamped body does, not what friction adds. Whatever friction does, energy never rises.
TYPED_TEST(FrictionSlopeTest, AddsNoEnergyToABlockThatRings) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : {Integrator::NewtonEuler, Integrator::Bdf2}) {
        BarrierScene<kDim> scene = slope<kDim>(ContactModel::Penalty, 1.04 * kFriction);
        scene.scene.damping.reset();
        scene.scene.bodies[0].material.lame = lame_from_young(kDim, 1e5, 0.28);
        scene.scene.bodies[0].place.translate[1] += 0.01;  // lands, which sets it ringing
        scene.scene.solver.integrator = integrator;
        Simulation<kDim> simulation(scene.scene, scene.meshes);
        const double start = simulation.energies().total();
        double before = start;
        for (int k = 0; k < 60; ++k) {
            const StepReport report = simulation.step();
            ASSERT_TRUE(report.is_accepted) << report.failure;
            // What Newton's method leaves unbalanced.
            ASSERT_LE(report.energies.total(), before + 1e-6 * std::abs(start)) << k;
            before = report.energies.total();
        }
        EXPECT_LT(before, start);
    }
}

}  // namespace
}  // namespace pent::simulator
