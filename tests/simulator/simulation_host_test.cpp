#include "host_scenes.h"

#include <gtest/gtest.h>

#include <functional>

// A simulation that a host drives: scene and meshes are made in memory, and no file is there.

namespace pent::simulator {
namespace {

using test::all_vertices;
using test::corner;
using test::cube;
using test::Dimensions;
using test::expect_same;
using test::floating_cube;
using test::kWithInertia;
using test::low_side;
using test::mean_velocity;
using test::places_of;
using test::take_step;

template <typename T>
class Host : public testing::Test {};
TYPED_TEST_SUITE(Host, Dimensions);

// ---- targets

TYPED_TEST(Host, TakesHeldVerticesToTheirTargetsByTheEndOfAStep) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : kWithInertia) {
        Scene scene = floating_cube<kDim>(integrator);
        scene.gravity[1] = -9.8;
        Simulation<kDim> simulation(scene, {cube<kDim>()});
        take_step(simulation);
        const auto side = low_side(simulation, 0);
        const Positions<kDim> start = places_of(simulation, 0, side);
        Positions<kDim> targets = start;
        targets.row(0).array() -= 0.02;
        simulation.set_targets(0, side, targets);
        EXPECT_EQ(simulation.size().free_vertices,
                  simulation.mesh(0).vertex_count() - std::int64_t(side.size()));
        take_step(simulation);
        EXPECT_EQ(places_of(simulation, 0, side), targets);
        for (std::size_t i = 0; i < side.size(); ++i) {  // 0.02 m in 10 ms
            EXPECT_LT((simulation.velocities(0).col(side[i]) + 2 * Vector<kDim>::Unit(0)).norm(),
                      1e-12);
        }
        take_step(simulation);  // there it stays
        EXPECT_EQ(places_of(simulation, 0, side), targets);
        EXPECT_EQ(simulation.velocities(0).col(side[0]), Vector<kDim>::Zero());
        simulation.release(0, side);
        EXPECT_EQ(simulation.size().free_vertices, simulation.mesh(0).vertex_count());
        take_step(simulation);
        EXPECT_GT((places_of(simulation, 0, side) - targets).norm(), 1e-5);
    }
}

// What a host says by targets is what a constraint says by a motion.
TYPED_TEST(Host, MovesVerticesAsAConstraintDoes) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : kWithInertia) {
        Scene scene = floating_cube<kDim>(integrator);
        Simulation<kDim> driven(scene, {cube<kDim>()});
        scene.constraints = {
            test::hold(HalfSpaceSelection{.normal = Eigen::VectorXd::Unit(kDim, 0), .offset = 1e-6},
                       test::still(kDim))};
        scene.constraints[0].motion[0].translate[1] = 3;
        Simulation<kDim> constrained(scene, {cube<kDim>()});
        const auto side = low_side(driven, 0);
        Positions<kDim> targets = places_of(driven, 0, side);
        for (int i = 0; i < 10; ++i) {
            targets.row(1).array() += 0.03;
            driven.set_targets(0, side, targets);
            take_step(driven);
            take_step(constrained);
            // To rounding, which the linear solver spreads: 1e-12 of some cm.
            EXPECT_LT((driven.positions(0) - constrained.positions(0)).norm(), 1e-10) << i;
            EXPECT_LT((driven.velocities(0) - constrained.velocities(0)).norm(), 1e-8) << i;
        }
    }
}

// A constraint holds from 30 to 80 ms and moves; the host takes over from 50 ms, and lets go behind
// it or before its end.
TYPED_TEST(Host, HasItsTargetsInPlaceOfConstraintsThatComeAndGo) {
    constexpr int kDim = TypeParam::value;
    for (const int last : {6, 12}) {
        Scene scene = floating_cube<kDim>();
        scene.gravity[1] = -9.8;
        scene.constraints = {
            test::hold(HalfSpaceSelection{.normal = Eigen::VectorXd::Unit(kDim, 0), .offset = 1e-6},
                       test::still(kDim))};
        scene.constraints[0].motion[0].translate[0] = -1;
        scene.constraints[0].from = 0.03;
        scene.constraints[0].to = 0.08;
        Simulation<kDim> simulation(scene, {cube<kDim>()});
        const auto side = low_side(simulation, 0);
        const std::int64_t all = simulation.mesh(0).vertex_count();
        Positions<kDim> taken_up;
        for (int i = 0; i < 15; ++i) {
            const Positions<kDim> before = places_of(simulation, 0, side);
            if (i == 3) {
                taken_up = before;
            } else if (i == 5) {
                simulation.set_targets(0, side, before);
            } else if (i == last) {
                simulation.release(0, side);
            }
            take_step(simulation);
            const Positions<kDim> now = places_of(simulation, 0, side);
            const bool is_host = i >= 5 && i < last;
            const bool is_constraint = i >= 3 && i < 8 && !is_host;
            EXPECT_EQ(now == before, is_host) << i;
            EXPECT_EQ(simulation.size().free_vertices < all, is_host || is_constraint) << i;
            if (is_constraint) {  // where its motion has them, whatever the host did meanwhile
                Positions<kDim> expected = taken_up;
                expected.row(0).array() -= 0.01 * (i - 2);
                EXPECT_LT((now - expected).norm(), 1e-12) << i;
            }
        }
    }
}

TYPED_TEST(Host, LetsGoOfVerticesWithTheVelocityThatTheyHave) {
    constexpr int kDim = TypeParam::value;
    Simulation<kDim> simulation(floating_cube<kDim>(), {cube<kDim>(1)});
    const auto all = all_vertices(simulation, 0);
    Positions<kDim> targets = simulation.positions(0);
    for (int i = 0; i < 5; ++i) {
        targets.row(0).array() += 0.02;
        simulation.set_targets(0, all, targets);
        take_step(simulation);
    }
    simulation.release(0, all);
    for (int i = 0; i < 5; ++i) {
        take_step(simulation);
    }
    EXPECT_NEAR(simulation.positions(0)(0, 0), 0.2, 1e-10);
}

// A step that is cut in two goes to half of the way first: it ends where a whole one does.
TYPED_TEST(Host, TakesTargetsAlongInStepsThatAreCut) {
    constexpr int kDim = TypeParam::value;
    Scene scene = test::two_cubes<kDim>(0.2);
    scene.solver.integrator = Integrator::NewtonEuler;
    Simulation<kDim> simulation(scene, {cube<kDim>(1), cube<kDim>(1)});
    // Sideways by more than the thinnest body: refused as a possible tunnel, and cut.
    Positions<kDim> targets = simulation.positions(1);
    targets.row(0).array() += 0.7;
    simulation.set_targets(1, all_vertices(simulation, 1), targets);
    const StepReport report = simulation.step();
    ASSERT_TRUE(report.is_accepted) << report.failure;
    EXPECT_GT(report.substeps, 1);
    EXPECT_EQ(Positions<kDim>(simulation.positions(1)), targets);
    EXPECT_LT((mean_velocity(simulation, 1) - 70 * Vector<kDim>::Unit(0)).norm(), 1e-9);
}

// ---- grabs

// ---- states

// Without gravity, all at one velocity: whatever was before, it goes on from there.
TYPED_TEST(Host, PutsABodySomewhereInMidMotion) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : kWithInertia) {
        const Scene scene = floating_cube<kDim>(integrator);
        Simulation<kDim> simulation(scene, {cube<kDim>()});
        const Vector<kDim> velocity = Vector<kDim>::LinSpaced(1, 2);
        const auto vertices = simulation.mesh(0).vertex_count();
        for (const double speed : {1.0, 0.0, -2.0}) {
            take_step(simulation);
            take_step(simulation);
            const Positions<kDim> start = simulation.positions(0).array() + 0.1;
            const Positions<kDim> velocities = speed * velocity.replicate(1, vertices);
            simulation.set_state(0, start, velocities);
            for (int i = 0; i < 4; ++i) {
                take_step(simulation);
            }
            const Positions<kDim> end = start + 4 * scene.dt() * velocities;
            EXPECT_LT((simulation.positions(0) - end).cwiseAbs().maxCoeff(), 1e-9);
            EXPECT_LT((simulation.velocities(0) - velocities).cwiseAbs().maxCoeff(), 1e-6);
        }
    }
}

// ---- forces and gravity

TYPED_TEST(Host, PushesByForcesUntilItTakesThemAway) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : kWithInertia) {
        Simulation<kDim> simulation(floating_cube<kDim>(integrator), {cube<kDim>()});
        // Of a uniform acceleration, so that the body moves as a whole.
        const Vector<kDim> a = Vector<kDim>::LinSpaced(1, 2);
        simulation.set_forces(0, a * simulation.masses(0).transpose());
        for (int i = 0; i < 10; ++i) {
            take_step(simulation);
        }
        EXPECT_LT((mean_velocity(simulation, 0) - 0.1 * a).norm(), 1e-9);
        EXPECT_NEAR(simulation.energies().of("force"),
                    -a.dot(simulation.positions(0) * simulation.masses(0)), 1e-9);
        simulation.set_forces(0, Positions<kDim>::Zero(kDim, simulation.mesh(0).vertex_count()));
        EXPECT_EQ(simulation.host().forces.cols(), 0);
        const Vector<kDim> before = mean_velocity(simulation, 0);
        take_step(simulation);
        // BDF2 still has the last step in it: it goes by a third of what the last one did.
        EXPECT_LT((mean_velocity(simulation, 0) - before).norm(),
                  integrator == Integrator::Bdf2 ? 0.01 * a.norm() : 1e-9);
    }
}

TYPED_TEST(Host, ChangesGravityToThatOfAnotherScene) {
    constexpr int kDim = TypeParam::value;
    Scene scene = floating_cube<kDim>();
    Simulation<kDim> driven(scene, {cube<kDim>()});
    scene.gravity = Vector<kDim>::LinSpaced(-3, 5);
    Simulation<kDim> heavy(scene, {cube<kDim>()});
    driven.set_gravity(scene.gravity);
    for (int i = 0; i < 5; ++i) {
        take_step(driven);
        take_step(heavy);
    }
    expect_same(driven, heavy);
    EXPECT_EQ(driven.energies().of("gravity"), heavy.energies().of("gravity"));
    heavy.set_gravity(Vector<kDim>::Zero());
    const Vector<kDim> speed = mean_velocity(heavy, 0);
    take_step(heavy);
    EXPECT_LT((mean_velocity(heavy, 0) - speed).norm(), 1e-9);
    EXPECT_EQ(heavy.energies().of("gravity"), 0);
}

// ---- sleep

TYPED_TEST(Host, WakesWhatSleepsByWhateverItDoes) {
    constexpr int kDim = TypeParam::value;
    Scene scene = floating_cube<kDim>();
    scene.sleep = Sleep{.speed = 1e-3, .time = 0.05};
    const std::vector<std::function<void(Simulation<kDim>&)>> deeds = {
        [](auto& s) { static_cast<void>(s.add_grab(corner(s, 0))); },
        [](auto& s) { s.move_grab(1, corner(s, 0).anchor * 1.1); },
        [](auto& s) { s.remove_grab(1); },
        [](auto& s) { s.set_gravity(-Vector<kDim>::Unit(1)); },
        [](auto& s) { s.set_gravity(Vector<kDim>::Zero()); },
        [](auto& s) { s.set_forces(0, Positions<kDim>::Ones(kDim, s.masses(0).size())); },
        [](auto& s) { s.set_forces(0, Positions<kDim>::Zero(kDim, s.masses(0).size())); },
        [](auto& s) { s.set_targets(0, {0}, s.positions(0).leftCols(1)); },
        [](auto& s) { s.set_targets(0, {0}, 1.01 * s.positions(0).leftCols(1).array() + 0.1); },
        [](auto& s) { s.release(0, {0}); },
    };
    for (std::size_t deed = 0; deed < deeds.size(); ++deed) {
        Simulation<kDim> simulation(scene, {cube<kDim>(1)});
        // What has to be there for it: a grab, gravity, forces, something held.
        for (std::size_t earlier = 0; earlier < deed; ++earlier) {
            const bool is_needed = (deed <= 2 && earlier == 0) || (deed == 4 && earlier == 3)
                                   || (deed == 6 && earlier == 5) || (deed >= 8 && earlier == 7);
            if (is_needed) {
                deeds[earlier](simulation);
            }
        }
        // However it moves now: let it sleep by force.
        Snapshot<kDim> snapshot = simulation.save();
        snapshot.velocities.setZero();
        snapshot.sleep[0].is_asleep = true;
        simulation.restore(snapshot);
        deeds[deed](simulation);
        take_step(simulation);
        EXPECT_FALSE(simulation.sleep()[0].is_asleep) << deed;
    }
}

}  // namespace
}  // namespace pent::simulator
