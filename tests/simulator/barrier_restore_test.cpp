#include "barrier_scenes.h"
#include "host_scenes.h"
#include "support/messages.h"

#include <pent/simulator/crossing_error.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

// With a barrier, too, a state that a simulation was in can be put back.

namespace pent::simulator {
namespace {

using test::all_vertices;
using test::BarrierScene;
using test::box;
using test::expect_same;
using test::places_of;
using test::take_step;
using test::vector;

template <typename T>
class BarrierRestore : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(BarrierRestore, Dimensions);

template <int Dim>
SimplexMesh<Dim> small_box() {
    return box<Dim>(1, 1, 1, Eigen::VectorXd::Constant(Dim, 0.2));
}

// Holds a whole body for a host where it is.
template <int Dim>
void hold(Simulation<Dim>& simulation, int body) {
    const std::vector<std::uint32_t> all = all_vertices(simulation, body);
    simulation.set_targets(body, all, places_of(simulation, body, all));
}

// A body is held and taken down to so far above an obstacle, which sees its vertices or its facets,
// or above another body. Where it arrives the state can be put into a new simulation; where that
// would be too near, the step is refused with what touches, and nothing has moved.
TYPED_TEST(BarrierRestore, TakesEveryStateThatTargetsLeadTo) {
    constexpr int kDim = TypeParam::value;
    const Obstacle floor{.shape = HalfSpaceObstacle{.normal = vector<kDim>(0, 1), .offset = 0}};
    const Obstacle ball{.shape = BallObstacle{.center = vector<kDim>(0.01, -0.5), .radius = 0.5}};
    for (const std::vector<Obstacle>& obstacles : {std::vector{floor}, {ball}, {}}) {
        for (const double gap : {1e-3, 1e-6, 1e-9, 1e-13, 1e-16, 1e-300, 0.0}) {
            BarrierScene<kDim> scene;
            scene.scene.solver.max_halvings = 2;
            scene.scene.obstacles = obstacles;
            scene.add(small_box<kDim>(), vector<kDim>(0, 0.15));
            if (obstacles.empty()) {
                scene.add(small_box<kDim>(), vector<kDim>(0.03, -0.1, 0.02));
            }
            Simulation<kDim> simulation(scene.scene, scene.meshes);
            const Positions<kDim> before = simulation.positions(0);
            const std::vector<std::uint32_t> all = all_vertices(simulation, 0);
            Positions<kDim> targets = before;
            targets.row(1) =
                (before.row(1).array() > 0.1)
                    .select(gap + 0.2, Eigen::RowVectorXd::Constant(before.cols(), gap));
            simulation.set_targets(0, all, targets);
            const StepReport report = simulation.step();
            if (gap >= 1e-9 || obstacles.empty()) {
                EXPECT_TRUE(report.is_accepted) << gap << ": " << report.failure;
            }
            if (report.is_accepted) {
                EXPECT_EQ(simulation.positions(0), targets);
            } else {
                pent::test::expect_contains(report.failure, {"of 'a' touches obstacle 1"});
                EXPECT_EQ(simulation.positions(0), before);
            }
            Simulation<kDim> other(scene.scene, scene.meshes);
            ASSERT_NO_THROW(other.restore(simulation.save())) << gap;
            expect_same(simulation, other);
        }
    }
}

// The same where the body stays and the obstacle comes.
TYPED_TEST(BarrierRestore, TakesEveryStateThatAnObstacleLeadsTo) {
    constexpr int kDim = TypeParam::value;
    for (const double gap : {1e-3, 1e-9, 1e-13}) {
        BarrierScene<kDim> scene;
        scene.scene.solver.max_halvings = 2;
        scene.add(small_box<kDim>(), vector<kDim>(0, 0.15));
        Motion rising;
        rising.translate = vector<kDim>(0, (0.05 - gap) * scene.scene.frames_per_second);
        scene.scene.obstacles = {
            {.shape = HalfSpaceObstacle{.normal = vector<kDim>(0, 1), .offset = 0},
             .motion = {rising}}};
        Simulation<kDim> simulation(scene.scene, scene.meshes);
        hold(simulation, 0);
        const StepReport report = simulation.step();
        EXPECT_EQ(report.is_accepted, gap >= 1e-9) << gap << ": " << report.failure;
        Simulation<kDim> other(scene.scene, scene.meshes);
        ASSERT_NO_THROW(other.restore(simulation.save())) << gap;
        expect_same(simulation, other);
    }
}

// Two bodies that touch while constraints hold them may begin so, and be put back so whatever is
// held by then.
TYPED_TEST(BarrierRestore, TakesBodiesThatTouchWhereTheStateHoldsThem) {
    constexpr int kDim = TypeParam::value;
    BarrierScene<kDim> scene;
    for (const double height : {0.0, 0.2}) {
        scene.add(small_box<kDim>(), vector<kDim>(0, height));
        scene.hold(vector<kDim>(-9, -9, -9), vector<kDim>(9, 9, 9), vector<kDim>(0.3, 0));
        scene.scene.constraints.back().to = 0.02;  // two steps
    }
    Simulation<kDim> simulation(scene.scene, scene.meshes);
    const Snapshot<kDim> start = simulation.save();
    take_step(simulation);
    const Snapshot<kDim> first = simulation.save();
    take_step(simulation);
    const Positions<kDim> second = simulation.positions(1);
    EXPECT_FALSE(simulation.step().is_accepted);  // they are let go, and touch
    Positions<kDim> apart = second;
    apart.row(1).array() += 0.1;
    simulation.set_state(1, apart, Positions<kDim>::Zero(kDim, apart.cols()));
    take_step(simulation);
    for (const Snapshot<kDim>& back : {start, first}) {
        ASSERT_NO_THROW(simulation.restore(back));
        while (simulation.step_count() < 2) {
            take_step(simulation);
        }
        EXPECT_EQ(simulation.positions(1), second);
        simulation.set_state(1, apart, Positions<kDim>::Zero(kDim, apart.cols()));
        take_step(simulation);
    }
}

// A state that is refused leaves all as it was: forces of friction, too, which are held from the
// start of the last step, and where an obstacle is.
TYPED_TEST(BarrierRestore, ChangesNothingWhereItIsRefused) {
    constexpr int kDim = TypeParam::value;
    BarrierScene<kDim> scene;
    scene.scene.gravity = vector<kDim>(0, -9.8);
    scene.scene.contact->friction = 0.5;
    scene.add(small_box<kDim>(), vector<kDim>(0, 0.11)).velocity = vector<kDim>(1, 0);
    Motion rising;
    rising.translate = vector<kDim>(0, 0.01);
    scene.scene.obstacles = {{.shape = HalfSpaceObstacle{.normal = vector<kDim>(0, 1), .offset = 0},
                              .motion = {rising}}};
    Simulation<kDim> simulation(scene.scene, scene.meshes);
    Simulation<kDim> other(scene.scene, scene.meshes);
    for (int k = 0; k < 5; ++k) {
        take_step(simulation);
        take_step(other);
    }
    ASSERT_GT(simulation.energies().of("friction"), 0);
    Snapshot<kDim> below = simulation.save();
    below.steps += 10;
    below.positions.row(1).array() -= 0.5;
    EXPECT_THROW(simulation.restore(below), CrossingError<kDim>);
    EXPECT_EQ(simulation.forces(0), other.forces(0));
    EXPECT_EQ(simulation.contact_forces(0), other.contact_forces(0));
    EXPECT_EQ(simulation.energies().of("friction"), other.energies().of("friction"));
    EXPECT_EQ(std::get<HalfSpace<kDim>>(simulation.obstacles()[0]).offset,
              std::get<HalfSpace<kDim>>(other.obstacles()[0]).offset);
    take_step(simulation);
    take_step(other);
    expect_same(simulation, other);
}

// What a host holds from then on may touch on, but is not let go where it would not be free to
// move.
TYPED_TEST(BarrierRestore, HoldsOnToWhatTouches) {
    constexpr int kDim = TypeParam::value;
    BarrierScene<kDim> scene;
    for (const double height : {0.0, 0.2}) {
        scene.add(small_box<kDim>(), vector<kDim>(0, height));
        scene.hold(vector<kDim>(-9, -9, -9), vector<kDim>(9, 9, 9), vector<kDim>(0, 0));
        scene.scene.constraints.back().to = 0.01;
    }
    Simulation<kDim> simulation(scene.scene, scene.meshes);
    hold(simulation, 0);
    hold(simulation, 1);
    for (int k = 0; k < 3; ++k) {
        take_step(simulation);
    }
    const std::vector<std::uint32_t> all = all_vertices(simulation, 1);
    EXPECT_THROW(simulation.release(1, all), CrossingError<kDim>);
    EXPECT_EQ(simulation.host().held.size(), 2 * all.size());
    const Snapshot<kDim> touching = simulation.save();
    Positions<kDim> apart = simulation.positions(1);
    apart.row(1).array() += 0.1;
    simulation.set_state(1, apart, Positions<kDim>::Zero(kDim, apart.cols()));
    EXPECT_NO_THROW(simulation.release(1, all));
    take_step(simulation);
    ASSERT_NO_THROW(simulation.restore(touching));
    take_step(simulation);
}

}  // namespace
}  // namespace pent::simulator
