#include "contact_scenes.h"

#include <gtest/gtest.h>

// What a scene leaves out does no work: counted, not timed.

namespace pent::simulator {
namespace {

using test::cube;
using test::two_cubes;

StepReport first_step(const Scene& scene) {
    std::vector<SimplexMesh<4>> meshes(scene.bodies.size(), cube<4>());
    StepReport report = Simulation<4>(scene, std::move(meshes)).step();
    EXPECT_TRUE(report.is_accepted) << report.failure;
    return report;
}

// Of a cube: 2^4 cells of 24 simplices.
constexpr std::int64_t kElements = 384;

TEST(Damping, AssemblesATangentOfItsOwnOnlyForNewtonsMethodWithStiffness) {
    Scene scene = test::box_scene<4>();
    scene.bodies[0].spin = {{.plane = {0, 3}, .degrees_per_s = 90}};
    for (const Integrator integrator :
         {Integrator::LinearEuler, Integrator::NewtonEuler, Integrator::Bdf2}) {
        scene.solver.integrator = integrator;
        const bool is_newton = integrator != Integrator::LinearEuler;
        scene.damping.reset();
        const StepReport without = first_step(scene);
        EXPECT_EQ(without.damping_hessians, 0);
        EXPECT_EQ(without.hessians, kElements * (1 + without.newton_iterations));
        scene.damping = Damping{.mass = 0.1, .stiffness = 0};
        EXPECT_EQ(first_step(scene).damping_hessians, 0);
        scene.damping = Damping{.mass = 0, .stiffness = 0.01};
        EXPECT_EQ(first_step(scene).damping_hessians, is_newton ? kElements : 0);
    }
}

TEST(Obstacles, AreTestedAgainstEveryFreeVertexAndNotAtAllWithoutThem) {
    Scene scene = test::box_scene<4>();
    EXPECT_EQ(first_step(scene).contact.obstacle_tests, 0);
    const HalfSpaceObstacle floor{.normal = Eigen::Vector4d::UnitY(), .offset = -1};
    scene.obstacles = {{.shape = floor}, {.shape = floor}};
    EXPECT_EQ(first_step(scene).contact.obstacle_tests, 0);  // nothing has moved
    scene.gravity[1] = -1;
    EXPECT_EQ(first_step(scene).contact.obstacle_tests, 2 * 81);
    EXPECT_EQ(first_step(scene).contact.searches, 0);  // of pairs there are none to look for
    scene.constraints = {test::hold(
        HalfSpaceSelection{.normal = Eigen::Vector4d(1, 0, 0, 0), .offset = 1e-6}, test::still(4))};
    EXPECT_EQ(first_step(scene).contact.obstacle_tests, 2 * 54);  // a third is held
}

TEST(ContactWithinBodies, LooksAtNoPairUnlessAsked) {
    Scene scene = two_cubes<4>(5);
    for (const bool self : {false, true}) {
        scene.contact->self = self;
        Simulation<4> simulation(scene, {cube<4>(), cube<4>()});
        // Pressed flat: the two sides of a body are nearer to each other than the distance of
        // contact.
        Positions<4> flat = simulation.positions(0);
        flat.row(0) *= 0.01;
        simulation.set_state(0, flat, simulation.velocities(0));
        EXPECT_EQ(simulation.step().contact.candidates > 0, self);
    }
}

TEST(Friction, IsComputedForNoContactUnlessAsked) {
    Scene scene = two_cubes<4>(0.01);
    scene.obstacles = {
        {.shape = HalfSpaceObstacle{.normal = Eigen::Vector4d::UnitY(), .offset = -0.01}}};
    const StepReport without = first_step(scene);
    EXPECT_GT(without.contact.mixed, 0);
    EXPECT_GT(without.contact.obstacle, 0);
    EXPECT_EQ(without.contact.friction, 0);
    EXPECT_EQ(without.energies.of("friction"), 0);
    scene.contact->friction = 0.3;
    EXPECT_GT(first_step(scene).contact.friction, 0);
}

TEST(PenaltyContact, NeverAsksHowFarAStepMayGo) {
    Scene scene = two_cubes<4>(0.06);
    scene.bodies[0].velocity = Eigen::Vector4d(0, 1, 0, 0);
    scene.solver.integrator = Integrator::NewtonEuler;
    const StepReport penalty = first_step(scene);
    EXPECT_EQ(penalty.contact.ccd_seconds, 0);
    EXPECT_EQ(penalty.contact.stiffness, 0);
    scene.contact->model = ContactModel::Barrier;
    EXPECT_GT(first_step(scene).contact.ccd_seconds, 0);
}

TEST(Filter, TakesNoSecondAssemblyWhereNothingIsNegative) {
    Scene scene = test::box_scene<4>();
    scene.bodies[0].velocity = Eigen::Vector4d(0, 1, 0, 0);
    for (const Filter filter : {Filter::None, Filter::Clamp, Filter::Absolute}) {
        scene.solver.filter = filter;
        EXPECT_EQ(first_step(scene).hessians, kElements);
    }
}

// Whether floats were tried first depends on the step before, which nobody knows behind a snapshot.
TEST(Precision, IsCountedOnceWhereDoublesAreNeeded) {
    Scene scene = test::box_scene<4>();
    scene.bodies[0].material.lame = lame_from_young(4, 1e12, 0.2);
    scene.gravity[1] = -1;
    Simulation<4> whole(scene, {cube<4>()});
    Simulation<4> often(scene, {cube<4>()});
    for (int step = 0; step < 4; ++step) {
        const StepReport report = whole.step();
        ASSERT_TRUE(report.is_accepted) << report.failure;
        EXPECT_EQ(report.hessians, kElements) << step;
        const StepReport resumed = often.step();
        EXPECT_EQ(resumed.hessians, report.hessians) << step;
        EXPECT_EQ(resumed.unknowns, report.unknowns) << step;
        EXPECT_EQ(resumed.filtered, report.filtered) << step;
        Simulation<4> next(scene, {cube<4>()});
        next.restore(often.save());
        often = std::move(next);
    }
}

// The first step of a cube that is `stretch` times as large as at rest, short enough for every
// filter.
StepReport step_stretched(Filter filter, double stretch) {
    Scene scene = test::box_scene<4>();
    scene.frames_per_second = 3000;
    scene.solver.filter = filter;
    Simulation<4> simulation(scene, {cube<4>()});
    simulation.set_state(0, stretch * simulation.positions(0), simulation.velocities(0));
    StepReport report = simulation.step();
    EXPECT_TRUE(report.is_accepted) << report.failure;
    EXPECT_EQ(report.hessians, kElements);
    return report;
}

// Of a simplex 0.7 times as large the twists are negative, mu (1 - 0.49) + (lambda + mu)(0.24 - 1)
// 0.49; of one 1.02 times as large nothing is.
TEST(Filter, ChangesNoElementWhereItIsOffAndThoseWithNegativeEigenvaluesWhereItIsOn) {
    EXPECT_EQ(step_stretched(Filter::None, 0.7).filtered, 0);
    for (const Filter filter : {Filter::Clamp, Filter::Absolute}) {
        EXPECT_EQ(step_stretched(filter, 0.7).filtered, kElements);
        EXPECT_EQ(step_stretched(filter, 1.02).filtered, 0);
    }
}

// Long steps leave the masses no say: conjugate gradients meet a direction of negative curvature.
TEST(Filter, IsClampWhereTheMatrixIsNotPositiveDefiniteWithoutIt) {
    Scene scene = test::box_scene<4>();
    Positions<4> of_clamp;
    for (const Filter filter : {Filter::Clamp, Filter::None}) {
        scene.solver.filter = filter;
        Simulation<4> simulation(scene, {cube<4>()});
        simulation.set_state(0, 0.7 * simulation.positions(0), simulation.velocities(0));
        const StepReport report = simulation.step();
        ASSERT_TRUE(report.is_accepted) << report.failure;
        if (filter == Filter::Clamp) {
            of_clamp = simulation.positions(0);
            EXPECT_EQ(report.hessians, kElements);
        } else {
            EXPECT_EQ(report.hessians, 2 * kElements);
            EXPECT_EQ(Positions<4>(simulation.positions(0)), of_clamp);
        }
    }
}

// What a host may do and does not is in no report, no snapshot and no matrix.
TEST(Host, HasNothingThereUntilItDoesSomething) {
    Scene scene = test::box_scene<4>();
    scene.bodies[0].velocity = Eigen::Vector4d(0, 1, 0, 0);
    Simulation<4> simulation(scene, {cube<4>()});
    const StepReport report = simulation.step();
    ASSERT_EQ(report.energies.terms.size(), 1U);
    EXPECT_EQ(report.energies.terms[0].name, "elastic");
    const HostState<4> host = simulation.save().host;
    EXPECT_TRUE(!host.gravity && host.forces.cols() == 0 && host.grabs.empty()
                && host.held.empty());
    const std::int64_t unknowns = report.unknowns;
    simulation.set_targets(0, {0}, simulation.positions(0).leftCols(1));
    EXPECT_EQ(simulation.step().unknowns, unknowns - 4);
    simulation.release(0, {0});
    EXPECT_EQ(simulation.step().unknowns, unknowns);
    EXPECT_TRUE(simulation.save().host.held.empty());
}

TEST(History, IsKeptForBdf2Alone) {
    Scene scene = test::box_scene<4>();
    for (const Integrator integrator :
         {Integrator::LinearEuler, Integrator::NewtonEuler, Integrator::Bdf2}) {
        scene.solver.integrator = integrator;
        Simulation<4> simulation(scene, {cube<4>()});
        static_cast<void>(simulation.step());
        EXPECT_EQ(simulation.save().previous_positions.cols() > 0, integrator == Integrator::Bdf2);
    }
}

}  // namespace
}  // namespace pent::simulator
