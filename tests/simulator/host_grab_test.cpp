#include "host_scenes.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <map>

// Bodies that a host pulls by springs.

namespace pent::simulator {
namespace {

using test::corner;
using test::cube;
using test::Dimensions;
using test::floating_cube;
using test::kWithInertia;
using test::momentum;
using test::take_step;

template <typename T>
class HostGrab : public testing::Test {};
TYPED_TEST_SUITE(HostGrab, Dimensions);

// A point of a free body on a spring to a fixed anchor: the body is pulled by what the anchor
// feels, and a still one comes to rest at the anchor.
TYPED_TEST(HostGrab, TakesABodyToTheAnchorOfAGrab) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : kWithInertia) {
        Scene scene = floating_cube<kDim>(integrator);
        scene.damping = Damping{.mass = 3};
        Simulation<kDim> simulation(scene, {cube<kDim>(1)});
        Grab<kDim> grab = corner(simulation, 0);
        grab.damping = 30;
        const auto id = simulation.add_grab(grab);
        const Vector<kDim> goal = grab.anchor + 0.3 * Vector<kDim>::Unit(kDim - 1);
        simulation.move_grab(id, goal);
        for (int i = 0; i < 500; ++i) {
            take_step(simulation);
        }
        EXPECT_LT((place_of(simulation, grab.point) - goal).norm(), 2e-3);
    }
}

// The impulse of the spring is what the body's momentum gains, step by step: backward Euler takes
// the force at the end of a step.
TYPED_TEST(HostGrab, GivesABodyTheImpulseOfItsGrabAndNoOther) {
    constexpr int kDim = TypeParam::value;
    Simulation<kDim> simulation(floating_cube<kDim>(), {cube<kDim>()});
    Grab<kDim> grab = corner(simulation, 0, 500);
    grab.anchor += 0.1 * Vector<kDim>::LinSpaced(0.2, 1);
    static_cast<void>(simulation.add_grab(grab));
    Vector<kDim> before = momentum(simulation);
    for (int i = 0; i < 30; ++i) {
        take_step(simulation);
        const Vector<kDim> force = 500 * (grab.anchor - place_of(simulation, grab.point));
        const Vector<kDim> gained = momentum(simulation) - before;
        EXPECT_LT((gained - 0.01 * force).norm(), 1e-7 * force.norm()) << i;
        // What the simulation says of forces is the same.
        EXPECT_LT((simulation.forces(0).rowwise().sum() - force).norm(), 1e-8 * force.norm());
        before += gained;
    }
}

// Of three grabs of one point, each towards a place of its own, one is removed after the other.
TYPED_TEST(HostGrab, PullsNoMoreOnceItIsRemovedAndTheOthersDo) {
    constexpr int kDim = TypeParam::value;
    Simulation<kDim> simulation(floating_cube<kDim>(), {cube<kDim>(1)});
    const Grab<kDim> grab = corner(simulation, 0);
    std::map<std::uint64_t, Vector<kDim>> anchors;
    for (int axis = 0; axis < 3; ++axis) {
        Grab<kDim> one = grab;
        one.anchor += 0.1 * Vector<kDim>::Unit(axis);
        anchors[simulation.add_grab(one)] = one.anchor;
    }
    for (const std::uint64_t removed : {2, 3, 1}) {
        simulation.remove_grab(removed);
        EXPECT_EQ(anchors.erase(removed), 1);
        take_step(simulation);
        Vector<kDim> force = Vector<kDim>::Zero();
        for (const auto& [id, anchor] : anchors) {
            force += grab.stiffness * (anchor - place_of(simulation, grab.point));
        }
        EXPECT_LT((simulation.forces(0).rowwise().sum() - force).norm(), 1e-8 * grab.stiffness);
    }
}

// The whole mass on a spring, seen at the center of a stiff body: omega = sqrt(k / m).
TYPED_TEST(HostGrab, SwingsABodyAtTheFrequencyOfItsGrab) {
    constexpr int kDim = TypeParam::value;
    Scene scene = floating_cube<kDim>(Integrator::Bdf2);
    scene.bodies[0].material.lame = lame_from_young(kDim, 1e9, 0.1);
    Simulation<kDim> simulation(scene, {cube<kDim>()});
    const double mass = simulation.masses(0).sum();
    const double omega = 2;
    const Vector<kDim> middle = simulation.positions(0).rowwise().mean();
    const auto at = pick(simulation, Ray<kDim>{middle, Vector<kDim>::Unit(0)});
    Grab<kDim> grab{.point = at->point, .anchor = middle, .stiffness = omega * omega * mass};
    grab.anchor[1] += 0.1;
    static_cast<void>(simulation.add_grab(grab));
    double previous = 0;
    double crossing = 0;
    while (crossing == 0 && simulation.time() < 2) {
        take_step(simulation);
        const double now = simulation.positions(0).row(1).mean() - middle[1] - 0.1;
        if (now > 0 && simulation.step_count() > 1) {
            crossing = simulation.time() - 0.01 * now / (now - previous);
        }
        previous = now;
    }
    // A quarter of a period; BDF2 is right to (omega dt)^2, and its first step is backward Euler.
    EXPECT_NEAR(crossing, std::acos(0.0) / omega, 2e-3);
}

// Pulled as far, but no harder than its cells bear, no step fails, and let go the body is what it
// was.
TYPED_TEST(HostGrab, RecoversFromAHardPull) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : {Integrator::LinearEuler, Integrator::NewtonEuler}) {
        for (const double far : {1.1, 100.0}) {
            Scene scene = floating_cube<kDim>(integrator);
            scene.solver = {.integrator = integrator};
            scene.gravity[1] = -9.8;
            scene.damping = Damping{.mass = 1, .stiffness = 0.01};
            scene.constraints = {test::hold(
                HalfSpaceSelection{.normal = Eigen::VectorXd::Unit(kDim, 1), .offset = 1e-6},
                test::still(kDim))};
            Simulation<kDim> simulation(scene, {cube<kDim>()});
            const auto settle = [&] {
                for (int i = 0; i < 300; ++i) {
                    take_step(simulation);
                }
            };
            settle();
            const Positions<kDim> before = simulation.positions(0);
            Grab<kDim> grab = corner(simulation, 0, 20000);
            grab.anchor[kDim - 1] += far;
            const auto id = simulation.add_grab(grab);
            double farthest = 0;
            for (int i = 0; i < 60; ++i) {
                take_step(simulation);
                farthest = std::max(farthest, (simulation.positions(0) - before).norm());
            }
            EXPECT_GT(farthest, 0.05);  // it was a hard pull
            simulation.remove_grab(id);
            settle();
            EXPECT_LT((simulation.positions(0) - before).norm(), 1e-3) << far;
        }
    }
}

// Held still, a grab lets a body sleep; what does not change wakes nothing.
TYPED_TEST(HostGrab, LetsABodySleepOnAStillGrab) {
    constexpr int kDim = TypeParam::value;
    Scene scene = floating_cube<kDim>();
    scene.sleep = Sleep{.speed = 1e-3, .time = 0.05};
    Simulation<kDim> simulation(scene, {cube<kDim>(1)});
    static_cast<void>(simulation.add_grab(corner(simulation, 0)));
    simulation.set_targets(0, {0}, simulation.positions(0).leftCols(1));
    for (int i = 0; i < 5; ++i) {
        take_step(simulation);
    }
    EXPECT_TRUE(simulation.sleep()[0].is_asleep);
    simulation.set_gravity(Vector<kDim>::Zero());
    simulation.set_forces(0, Positions<kDim>::Zero(kDim, simulation.masses(0).size()));
    simulation.set_targets(0, {0}, simulation.positions(0).leftCols(1));
    simulation.release(0, {1});
    simulation.move_grab(1, corner(simulation, 0).anchor);
    take_step(simulation);
    EXPECT_TRUE(simulation.sleep()[0].is_asleep);
}

}  // namespace
}  // namespace pent::simulator
