#include "scenes.h"

#include <pent/simulator/simulation.h>

#include <gtest/gtest.h>

// Attempts at a step: when one fails, and what becomes of it.

namespace pent::simulator {
namespace {

using test::bar;
using test::box_scene;
using test::swinging_bar;

TEST(FailedStep, IsCutAndRetriedAndThenReportedWithTheStateAsItWas) {
    Scene scene = swinging_bar();
    scene.solver.max_iterations = 2;
    scene.solver.max_halvings = 2;
    Simulation<4> simulation(scene, {bar()});
    const Positions<4> before = simulation.positions(0);
    const StepReport report = simulation.step();
    EXPECT_FALSE(report.is_accepted);
    EXPECT_NE(report.failure.find("tolerance"), std::string::npos);
    EXPECT_EQ(report.refused, 3);
    EXPECT_EQ(simulation.positions(0), before);
    EXPECT_EQ(simulation.step_count(), 0U);
}

TEST(FailedStep, SucceedsInHalvesWhereThoseAreEasier) {
    Scene scene = swinging_bar();
    scene.damping.reset();
    Simulation<4> whole(scene, {bar()});
    scene.solver.max_iterations = whole.step().iterations * 3 / 4;
    Simulation<4> halved(scene, {bar()});
    const StepReport report = halved.step();
    EXPECT_TRUE(report.is_accepted);
    EXPECT_GE(report.substeps, 2);
    EXPECT_DOUBLE_EQ(halved.time(), scene.dt());
    EXPECT_NE(report.failure.find("the linear solver did not reach"), std::string::npos);
}

// Of so little mass that the linear solver copes, while squares of the way to go are beyond all
// numbers.
TEST(FailedStep, IsOneWhoseMotionHasAnEnergyThatIsNotANumber) {
    Scene scene = box_scene<4>();
    scene.solver.integrator = Integrator::NewtonEuler;
    scene.solver.precision = Precision::Double;
    scene.solver.max_halvings = 0;
    scene.bodies[0].material.density = 1e-20;
    scene.bodies[0].material.lame = lame_from_young(4, 1e-18, 0.28);
    scene.bodies[0].velocity = Eigen::Vector4d(1e165, 0, 0, 0);
    Simulation<4> simulation(scene, {bar(2)});
    const StepReport report = simulation.step();
    EXPECT_FALSE(report.is_accepted);
    EXPECT_EQ(report.failure, "the motion grew beyond all bounds");
}

// Sum of 1/2 m |v - before|^2, J.
double kinetic_energy(const Simulation<4>& simulation, const Positions<4>& before) {
    return 0.5
           * (simulation.velocities(0) - before).colwise().squaredNorm().dot(simulation.masses(0));
}

// Of backward Euler it is h^2 (1/2 |v - v0|_M^2 + E): no more behind a step than with all where it
// was, from however far the linear step that the search begins with may have leapt.
TEST(NewtonsMethod, NeverEndsAboveWhereTheStepBegan) {
    Scene scene = box_scene<4>();
    scene.solver.integrator = Integrator::NewtonEuler;
    for (const double frames_per_second : {1000.0, 30.0, 3.0}) {
        for (const double stretch : {0.05, 0.5, 2.0, 6.0}) {
            scene.frames_per_second = frames_per_second;
            Simulation<4> simulation(scene, {bar(3)});
            Positions<4> positions = simulation.positions(0);
            positions.row(0) *= stretch;
            positions.row(2) *= -1;  // inside out
            Positions<4> velocities = 0.3 * positions;
            velocities.row(1).swap(velocities.row(3));
            simulation.set_state(0, positions, velocities);
            const Energies before = simulation.energies();
            const StepReport report = simulation.step();
            ASSERT_TRUE(report.is_accepted) << report.failure;
            ASSERT_EQ(report.substeps, 1) << frames_per_second << ' ' << stretch;
            EXPECT_LE(kinetic_energy(simulation, velocities) + report.energies.of("elastic"),
                      before.kinetic + before.of("elastic"))
                << frames_per_second << ' ' << stretch;
        }
    }
}

}  // namespace
}  // namespace pent::simulator
