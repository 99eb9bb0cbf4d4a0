#include "scenes.h"
#include "support/host_tasks.h"

#include <pent/simulator/simulation.h>

#include <gtest/gtest.h>

#include <utility>
#include <vector>

// Same in, same out.

namespace pent::simulator {
namespace {

using test::bar;
using test::swinging_bar;

// All bits of positions and velocities after some steps.
std::vector<double> state_after(int steps, TaskSystem tasks, const Scene& scene, int length) {
    Simulation<4> simulation(scene, {bar(length)}, {.tasks = std::move(tasks)});
    for (int i = 0; i < steps; ++i) {
        EXPECT_TRUE(simulation.step().is_accepted);
    }
    const auto positions = simulation.positions(0).reshaped();
    const auto velocities = simulation.velocities(0).reshaped();
    std::vector<double> state(positions.begin(), positions.end());
    state.insert(state.end(), velocities.begin(), velocities.end());
    return state;
}

TEST(Stepper, IsTheSameToTheBitForAnyNumberOfThreads) {
    const std::vector<double> one =
        state_after(3, own_task_system(1), swinging_bar(), 80);  // 30,720 cells
    EXPECT_EQ(state_after(3, own_task_system(2), swinging_bar(), 80), one);
    for (const int threads : {2, 3, 8}) {
        EXPECT_EQ(state_after(3, pent::test::host_tasks(threads), swinging_bar(), 80), one)
            << threads << " threads of a host";
    }
}

TEST(Stepper, ContinuesToTheBitFromASavedState) {
    const Scene scene = swinging_bar();
    Simulation<4> first(scene, {bar()});
    for (int i = 0; i < 3; ++i) {
        ASSERT_TRUE(first.step().is_accepted);
    }
    Simulation<4> second(scene, {bar()});
    second.restore(first.save());
    for (int i = 0; i < 3; ++i) {
        ASSERT_TRUE(first.step().is_accepted);
        ASSERT_TRUE(second.step().is_accepted);
    }
    EXPECT_EQ(Positions<4>(first.positions(0)), Positions<4>(second.positions(0)));
}

// From any moment, under every integrator: BDF2 looks back further than its state.
TEST(Stepper, TakesTheSameStepsAgainWhenItIsPutBack) {
    for (const Integrator integrator :
         {Integrator::LinearEuler, Integrator::NewtonEuler, Integrator::Bdf2}) {
        Scene scene = swinging_bar();
        scene.solver.integrator = integrator;
        Simulation<4> simulation(scene, {bar(3)});
        for (int begin = 0; begin < 3; ++begin) {
            const Snapshot<4> snapshot = simulation.save();
            ASSERT_TRUE(simulation.step().is_accepted);
            const Positions<4> first = simulation.positions(0);
            ASSERT_TRUE(simulation.step().is_accepted);
            simulation.restore(snapshot);
            EXPECT_EQ(simulation.step_count(), snapshot.steps);
            ASSERT_TRUE(simulation.step().is_accepted);
            EXPECT_EQ(Positions<4>(simulation.positions(0)), first);
        }
    }
}

// What a body does does not depend on another that it never meets, but for the solver's tolerance.
TEST(Stepper, MovesBodiesThatNeverMeetAsIfEachWereAlone) {
    Scene scene = swinging_bar();
    scene.solver.precision = Precision::Double;
    scene.solver.tolerance = 1e-12;
    Simulation<4> alone(scene, {bar(3)});
    scene.bodies.push_back(scene.bodies[0]);
    scene.bodies[1].name = "other";
    scene.bodies[1].velocity = Eigen::Vector4d(1, 2, 3, 4);
    Simulation<4> both(scene, {bar(3), bar(2)});
    for (int i = 0; i < 3; ++i) {
        ASSERT_TRUE(alone.step().is_accepted);
        ASSERT_TRUE(both.step().is_accepted);
    }
    EXPECT_LT((alone.positions(0) - both.positions(0)).norm(), 1e-9);
}

}  // namespace
}  // namespace pent::simulator
