#include "contact_scenes.h"
#include "potential_laws.h"
#include "support/messages.h"

#include <pent/contact/contact.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

// Bodies that sleep are not solved for, and nothing else changes.

namespace pent::simulator {
namespace {

using test::cube;
using test::two_cubes;

// Solved so tightly that runs may be compared.
void solve_tightly(Scene& scene) {
    scene.solver.precision = Precision::Double;
    scene.solver.tolerance = 1e-12;
    scene.solver.newton_tolerance = 1e-8;
}

// A cube that rests on a floor, pressed into it a little.
template <int Dim>
Scene cube_on_floor() {
    Scene scene = test::box_scene<Dim>();
    scene.gravity[1] = -9.8;
    scene.obstacles = {{.shape = HalfSpaceObstacle{.normal = Eigen::VectorXd::Unit(Dim, 1)},
                        .distance = 0.02,
                        .stiffness = 2e4}};
    scene.sleep = Sleep{.speed = 1e-3, .time = 0.2};
    return scene;
}

template <int Dim>
void expect_sleep_on_floor() {
    Simulation<Dim> simulation(cube_on_floor<Dim>(), {cube<Dim>()});
    int steps = 0;
    StepReport report = simulation.step();
    for (; report.asleep == 0; ++steps) {
        ASSERT_LT(steps, 600);
        EXPECT_GT(report.unknowns, 0);
        report = simulation.step();
    }
    const Positions<Dim> positions = simulation.positions(0);
    const Positions<Dim> forces = simulation.forces(0);
    const Positions<Dim> push = simulation.contact_forces(0);
    const double energy = simulation.energies().total();
    for (int i = 0; i < 20; ++i) {
        report = simulation.step();
        ASSERT_TRUE(report.is_accepted);
        EXPECT_EQ(report.unknowns + report.hessians + report.iterations, 0);
    }
    EXPECT_EQ(simulation.positions(0), positions);
    EXPECT_TRUE(simulation.velocities(0).isZero(0));
    EXPECT_EQ(simulation.size().free_vertices, 0);
    EXPECT_EQ(simulation.size().matrix_blocks, 0);
    // Forces and energies are those of before, and the floor still carries the weight.
    EXPECT_EQ(simulation.forces(0), forces);
    EXPECT_EQ(simulation.contact_forces(0), push);
    EXPECT_EQ(simulation.energies().total(), energy);
    const double weight = 9.8 * simulation.masses(0).sum();
    EXPECT_NEAR(push.row(1).sum(), weight, 2e-2 * weight);
}

TEST(SleepingBody, StaysExactlyWhereItIsAndIsNotSolvedForInThreeDimensions) {
    expect_sleep_on_floor<3>();
}

TEST(SleepingBody, StaysExactlyWhereItIsAndIsNotSolvedForInFourDimensions) {
    expect_sleep_on_floor<4>();
}

// The floor leaves within one step, so that nothing touches it at the end of that step.
template <int Dim>
void expect_fall_from_floor_that_leaves(Integrator integrator, ContactModel model) {
    Scene scene = cube_on_floor<Dim>();
    scene.solver.integrator = integrator;
    scene.damping = Damping{.mass = 20, .stiffness = 0};
    scene.contact = ContactSettings{.model = model};
    std::get<HalfSpaceObstacle>(scene.obstacles[0].shape).offset = -0.01;
    Motion down = test::still(Dim);
    down.translate[1] = -4;
    down.from = 3;
    scene.obstacles[0].motion = {down};
    scene.sleep->speed = 0.01;
    Simulation<Dim> simulation(scene, {cube<Dim>(1)});
    while (simulation.time() < down.from - 1e-9) {
        ASSERT_TRUE(simulation.step().is_accepted);
    }
    ASSERT_TRUE(simulation.sleep()[0].is_asleep);
    for (int i = 0; i < 5; ++i) {
        const StepReport report = simulation.step();
        ASSERT_TRUE(report.is_accepted) << report.failure;
        EXPECT_EQ(report.asleep, 0) << i;
    }
    EXPECT_LT(test::mean_velocity(simulation, 0)[1], -0.2);  // of 0.49, where damping is weight
}

TEST(SleepingBody, FallsWhenTheFloorLeavesIt) {
    for (const Integrator integrator :
         {Integrator::LinearEuler, Integrator::NewtonEuler, Integrator::Bdf2}) {
        SCOPED_TRACE(static_cast<int>(integrator));
        expect_fall_from_floor_that_leaves<3>(integrator, ContactModel::Penalty);
    }
    expect_fall_from_floor_that_leaves<4>(Integrator::NewtonEuler, ContactModel::Penalty);
    expect_fall_from_floor_that_leaves<3>(Integrator::NewtonEuler, ContactModel::Barrier);
}

TEST(BodyThatNeverSleeps, MovesAsWithoutSleepToTheBit) {
    Scene scene = cube_on_floor<4>();
    scene.sleep->time = 1e6;
    Simulation<4> with(scene, {cube<4>()});
    scene.sleep.reset();
    Simulation<4> without(scene, {cube<4>()});
    for (int i = 0; i < 30; ++i) {
        EXPECT_EQ(with.step().asleep, 0);
        static_cast<void>(without.step());
    }
    EXPECT_EQ(with.positions(0), without.positions(0));
    EXPECT_EQ(with.velocities(0), without.velocities(0));
}

TEST(SleepingBody, KeepsElasticForcesAndEnergiesAsIfItWereAwake) {
    // Stretched between held ends: at rest under stress.
    Scene scene = test::box_scene<4>();
    scene.solver.integrator = Integrator::NewtonEuler;
    solve_tightly(scene);
    Motion pull = test::still(4);
    pull.translate[0] = 0.5;
    pull.to = 0.2;
    const HalfSpaceSelection left{.normal = Eigen::Vector4d(1, 0, 0, 0), .offset = 1e-6};
    const HalfSpaceSelection right{.normal = Eigen::Vector4d(-1, 0, 0, 0), .offset = -0.749999};
    scene.constraints = {test::hold(left, test::still(4)), test::hold(right, pull)};
    scene.damping = Damping{.mass = 20, .stiffness = 0.01};
    scene.sleep = Sleep{.speed = 1e-3, .time = 0.2};
    Simulation<4> simulation(scene, {test::bar(3)});
    for (int i = 0; i < 100 && simulation.step().asleep == 0; ++i) {
    }
    ASSERT_EQ(simulation.sleep()[0].is_asleep, true);
    scene.sleep.reset();
    Simulation<4> awake(scene, {test::bar(3)});
    awake.set_state(0, simulation.positions(0), simulation.velocities(0));
    EXPECT_GT(awake.energies().of("elastic"), 1);
    EXPECT_NEAR(simulation.energies().of("elastic") / awake.energies().of("elastic"), 1, 1e-12);
    const double scale = awake.forces(0).cwiseAbs().maxCoeff();
    EXPECT_LT((simulation.forces(0) - awake.forces(0)).cwiseAbs().maxCoeff(), 1e-12 * scale);
}

// What is reported of a body that sleeps on a held one.
template <int Dim>
struct Rest {
    Positions<Dim> push;   // of contact on the sleeper, N
    Positions<Dim> carry;  // of contact on what carries it, N
    double reaction;       // what holds that up, N
    double energy;         // of its contacts, J
    double stiffness;      // of the barrier, N/m
};

template <int Dim>
Rest<Dim> rest_of(const Simulation<Dim>& simulation, const StepReport& report) {
    double all = 0;
    double own = 0;
    for (const contact::Contact<Dim>& contact : simulation.contacts()) {
        all += contact.energy;
        own += contact.first.index == 1 || contact.second.index == 1 ? contact.energy : 0;
    }
    EXPECT_NEAR(report.energies.of("contact"), all, 1e-12 * all);
    return {simulation.contact_forces(1), simulation.contact_forces(0),
            report.constraints[0].force[1], own, report.contact.stiffness};
}

// b lies between a block and a press that comes down, so that the one stiffness that all contacts
// have rises, while a sleeps on a plate somewhere else.
template <int Dim>
void expect_rest_beside_a_press() {
    Scene scene = test::box_scene<Dim>();
    scene.gravity[1] = -9.8;
    scene.frames_per_second = 100;
    scene.solver.integrator = Integrator::NewtonEuler;
    scene.contact = ContactSettings{
        .model = ContactModel::Barrier, .distance = 0.02, .stiffness = Dim == 3 ? 100.0 : 10.0};
    scene.damping = Damping{.mass = 20, .stiffness = 0};
    scene.sleep = Sleep{.speed = 0.01, .time = 0.1};
    const Body one = scene.bodies[0];
    scene.bodies.clear();
    const auto add = [&](const char* name, double x, double y) {
        Body body = one;
        body.name = name;
        body.place.translate.setConstant(x);
        body.place.translate[1] = y;
        scene.bodies.push_back(body);
    };
    add("plate", 0, 0);
    add("a", 0.04, 0.265);
    add("block", 3, 0);
    add("b", 3.04, 0.265);
    add("press", 3.08, 0.56);
    Motion down = test::still(Dim);
    down.translate[1] = -0.5;
    down.from = 0.6;
    down.to = 0.9;
    for (const char* name : {"plate", "block", "press"}) {
        scene.constraints.push_back(
            {.body = name,
             .select = {EverythingSelection{}},
             .motion = {std::string(name) == "press" ? down : test::still(Dim)}});
    }
    Simulation<Dim> simulation(scene, std::vector<SimplexMesh<Dim>>(5, cube<Dim>(1)));
    const auto rest_at = [&](double time) {
        StepReport report;
        while (simulation.time() < time - 1e-9) {
            report = simulation.step();
            EXPECT_TRUE(report.is_accepted) << report.failure;
        }
        EXPECT_TRUE(simulation.sleep()[1].is_asleep) << time;
        return rest_of(simulation, report);
    };
    const Rest<Dim> before = rest_at(0.6);
    const Rest<Dim> after = rest_at(0.9);
    EXPECT_GT(after.stiffness, 2 * before.stiffness);
    // The same to rounding: a barrier's energy is proportional to its stiffness.
    const double weight = 9.8 * simulation.masses(1).sum();
    EXPECT_LT((after.push - before.push).norm(), 1e-12 * weight);
    EXPECT_LT((after.carry - before.carry).norm(), 1e-12 * weight);
    EXPECT_NEAR(after.energy, before.energy, 1e-12 * before.energy);
    EXPECT_NEAR(after.reaction, before.reaction, 1e-12 * weight);
    // Each pushes the other, and the plate carries both, but for the speed that is rest.
    EXPECT_LT((after.push + after.carry).rowwise().sum().norm(), 1e-12 * weight);
    EXPECT_NEAR(after.push.row(1).sum(), weight, 2e-2 * weight);
    EXPECT_NEAR(after.reaction, 2 * weight, 2e-2 * weight);
    // Put back into a simulation that has another stiffness, all is as it was.
    Simulation<Dim> other(scene, std::vector<SimplexMesh<Dim>>(5, cube<Dim>(1)));
    other.restore(simulation.save());
    EXPECT_EQ(other.contact_forces(0), simulation.contact_forces(0));
    EXPECT_EQ(other.energies().total(), simulation.energies().total());
}

TEST(SleepingBody, KeepsItsForcesWhereABarrierStiffensElsewhere) {
    expect_rest_beside_a_press<3>();
    expect_rest_beside_a_press<4>();
}

struct Hit {
    Integrator integrator;
    ContactModel model;
    int dim;
};

class SleepingBodyThatIsHit : public testing::TestWithParam<Hit> {};
INSTANTIATE_TEST_SUITE_P(All,
                         SleepingBodyThatIsHit,
                         testing::Values(Hit{Integrator::LinearEuler, ContactModel::Penalty, 3},
                                         Hit{Integrator::LinearEuler, ContactModel::Penalty, 4},
                                         Hit{Integrator::NewtonEuler, ContactModel::Penalty, 3},
                                         Hit{Integrator::Bdf2, ContactModel::Penalty, 4},
                                         Hit{Integrator::NewtonEuler, ContactModel::Barrier, 3},
                                         Hit{Integrator::Bdf2, ContactModel::Barrier, 4}));

// b falls on a, which has been asleep for long: from where they touch on all is as without sleep.
template <int Dim>
void expect_same_hit(const Hit& hit) {
    Scene scene = two_cubes<Dim>(0.2);
    scene.solver.integrator = hit.integrator;
    scene.contact->model = hit.model;
    solve_tightly(scene);
    scene.bodies[1].velocity = -1.5 * Eigen::VectorXd::Unit(Dim, 1);
    Simulation<Dim> awake(scene, {cube<Dim>(1), cube<Dim>(1)});
    scene.sleep = Sleep{.speed = 1e-3, .time = 0.05};
    Simulation<Dim> simulation(scene, {cube<Dim>(1), cube<Dim>(1)});
    const auto before = test::momentum(simulation);
    bool has_slept = false;
    double loaded = 0;
    for (int i = 0; i < 40; ++i) {
        const StepReport report = simulation.step();
        ASSERT_TRUE(report.is_accepted) << report.failure;
        ASSERT_TRUE(awake.step().is_accepted);
        has_slept = has_slept || report.asleep == 1;
        loaded = std::max(loaded, report.energies.of("contact"));
        // What Newton's method leaves of forces at kinks of contact is not our business.
        const double drift = (test::momentum(awake) - before).norm();
        ASSERT_LT((test::momentum(simulation) - before).norm(), drift + 1e-6 * before.norm()) << i;
        for (int body = 0; body < 2; ++body) {
            ASSERT_LT((simulation.positions(body) - awake.positions(body)).cwiseAbs().maxCoeff(),
                      1e-6)
                << i;
        }
    }
    EXPECT_TRUE(has_slept);
    EXPECT_GT(loaded, 0);
    EXPECT_FALSE(simulation.sleep()[0].is_asleep);
    EXPECT_LT(test::mean_velocity(simulation, 0)[1], -0.1);
}

TEST_P(SleepingBodyThatIsHit, WakesAndMovesAsWithoutSleep) {
    if (GetParam().dim == 3) {
        expect_same_hit<3>(GetParam());
    } else {
        expect_same_hit<4>(GetParam());
    }
}

// Where both cubes of a stack are at rest on a floor, one on the other.
Scene stack() {
    Scene scene = two_cubes<3>(0.03);
    scene.gravity[1] = -9.8;
    scene.obstacles = {
        {.shape = HalfSpaceObstacle{.normal = Eigen::Vector3d::UnitY(), .offset = -0.01},
         .distance = 0.02,
         .stiffness = 2e4}};
    scene.damping = Damping{.mass = 10, .stiffness = 0};
    scene.contact->friction = 0.6;  // the upper one would slide off
    scene.sleep = Sleep{.speed = 2e-3, .time = 0.1};
    return scene;
}

TEST(StackOfBodies, FallsAsleepTogetherAndWakesTogether) {
    Simulation<3> simulation(stack(), {cube<3>(), cube<3>()});
    int asleep = 0;
    for (int i = 0; i < 600 && asleep == 0; ++i) {
        asleep = simulation.step().asleep;
    }
    ASSERT_EQ(asleep, 2);  // neither before the other
    const Positions<3> lower = simulation.positions(0);
    EXPECT_EQ(simulation.step().unknowns, 0);
    // The host takes the upper one away: the lower one, which carried it, has to notice.
    Positions<3> away = simulation.positions(1);
    away.row(1).array() += 0.01;  // still in contact
    simulation.set_state(1, away, simulation.velocities(1));
    const StepReport report = simulation.step();
    EXPECT_EQ(report.asleep, 0);
    EXPECT_NE(simulation.positions(0), lower);
}

TEST(StackOfBodies, FallsWhenAHostTakesTheLowerOneAway) {
    Simulation<3> simulation(stack(), {cube<3>(), cube<3>()});
    for (int i = 0; i < 600 && simulation.step().asleep == 0; ++i) {
    }
    ASSERT_TRUE(simulation.sleep()[1].is_asleep);
    const double height = simulation.positions(1).row(1).mean();
    Positions<3> away = simulation.positions(0);
    away.row(0).array() += 5;
    simulation.set_state(0, away, simulation.velocities(0));
    EXPECT_EQ(simulation.step().asleep, 0);
    for (int i = 1; i < 20; ++i) {
        static_cast<void>(simulation.step());
    }
    EXPECT_LT(simulation.positions(1).row(1).mean(), height - 0.05);
}

// A row of cubes that touch, the first or the last of which is pushed: all wake in that step.
template <int Dim>
void expect_row_to_wake(int pushed) {
    constexpr int kCount = 4;
    Scene scene = two_cubes<Dim>(0);
    scene.solver.integrator = Integrator::LinearEuler;  // which looks once
    scene.sleep = Sleep{};
    scene.bodies.clear();
    for (int k = 0; k < kCount; ++k) {
        Body body = test::box_scene<Dim>().bodies[0];
        body.name = std::string(1, static_cast<char>('a' + k));
        body.place.translate.setConstant(0.01 * (k % 2));  // no vertex is at another
        body.place.translate[1] = 0.27 * k;
        scene.bodies.push_back(body);
    }
    scene.contact->stiffness = 1e-6;  // who touches counts here, and not how hard
    Simulation<Dim> simulation(scene, std::vector<SimplexMesh<Dim>>(kCount, cube<Dim>(1)));
    Snapshot<Dim> snapshot = simulation.save();
    for (SleepState& state : snapshot.sleep) {
        state.is_asleep = true;
    }
    simulation.restore(snapshot);
    EXPECT_EQ(simulation.step().asleep, kCount);
    test::throw_up(simulation, pushed, 1e-3);
    EXPECT_EQ(simulation.step().asleep, 0);
}

TEST(RowOfBodies, WakesFromEitherEnd) {
    for (const int pushed : {0, 1, 3}) {
        SCOPED_TRACE(pushed);
        expect_row_to_wake<3>(pushed);
        expect_row_to_wake<4>(pushed);
    }
}

// Two cubes on a slab that is held for good: one slides along it, and the other sleeps all the
// same. The slab itself neither sleeps nor is awake.
template <int Dim>
void expect_held_body_to_pass_nothing_on(Integrator integrator) {
    Scene scene = two_cubes<Dim>(0);
    scene.bodies.push_back(scene.bodies[0]);
    scene.bodies[2].name = "slab";
    scene.bodies[2].place.scale = 40;  // of cubes of 0.25 m
    scene.bodies[2].place.translate.setConstant(-5);
    scene.bodies[2].place.translate[1] = -10;
    scene.bodies[0].place.translate[1] = 0.04;  // of 0.05, at which contact begins
    scene.bodies[1].place.translate[0] = 2;
    scene.bodies[1].place.translate[1] = 0.04;
    scene.bodies[0].velocity = 1e-4 * Eigen::VectorXd::Unit(Dim, 0);  // as good as at rest
    scene.bodies[1].velocity = Eigen::VectorXd::Unit(Dim, 0);
    scene.contact->stiffness = 1e-6;
    scene.solver.integrator = integrator;
    scene.constraints = {{.body = "slab", .select = {EverythingSelection{}}, .motion = {}}};
    scene.sleep = Sleep{.speed = 1e-2, .time = 0.03};
    Simulation<Dim> simulation(scene, std::vector<SimplexMesh<Dim>>(3, cube<Dim>(1)));
    for (int i = 0; i < 10; ++i) {
        const StepReport report = simulation.step();
        ASSERT_TRUE(report.is_accepted) << report.failure;
        EXPECT_EQ(report.asleep, i < 2 ? 0 : 1) << i;
        EXPECT_EQ(simulation.sleep()[0].is_asleep, i >= 2) << i;
        EXPECT_FALSE(simulation.sleep()[1].is_asleep || simulation.sleep()[2].is_asleep) << i;
        EXPECT_EQ(simulation.velocities(0).isZero(0), i >= 2) << i;
        for (const int body : {0, 1}) {
            const auto touches = [&](const contact::Contact<Dim>& contact) {
                return static_cast<int>(contact.first.index) == body
                       || static_cast<int>(contact.second.index) == body;
            };
            const auto contacts = simulation.contacts();
            EXPECT_TRUE(std::any_of(contacts.begin(), contacts.end(), touches)) << i;
        }
    }
}

TEST(SleepingBody, IsNotKeptAwakeThroughOneThatIsHeld) {
    for (const Integrator integrator :
         {Integrator::LinearEuler, Integrator::NewtonEuler, Integrator::Bdf2}) {
        SCOPED_TRACE(static_cast<int>(integrator));
        expect_held_body_to_pass_nothing_on<3>(integrator);
    }
    expect_held_body_to_pass_nothing_on<4>(Integrator::Bdf2);
}

// Slow enough to fall asleep, and woken in the next step by nothing that would move it: it stays.
TEST(SleepingBody, IsAtRestThoughItIsWokenAtOnce) {
    for (const Integrator integrator :
         {Integrator::LinearEuler, Integrator::NewtonEuler, Integrator::Bdf2}) {
        Scene scene = test::box_scene<3>();
        scene.solver.integrator = integrator;
        scene.bodies[0].velocity = Eigen::Vector3d(1e-4, 0, 0);
        scene.sleep = Sleep{.speed = 1e-2, .time = 0.2};
        Simulation<3> simulation(scene, {cube<3>(1)});
        while (simulation.step().asleep == 0) {
            ASSERT_LT(simulation.step_count(), 10U);
        }
        const Positions<3> before = simulation.positions(0);
        simulation.set_forces(0, Positions<3>::Constant(3, before.cols(), 1e-300));
        EXPECT_EQ(simulation.step().asleep, 0);
        EXPECT_LT((simulation.positions(0) - before).cwiseAbs().maxCoeff(), 1e-14);
        EXPECT_LT(simulation.velocities(0).cwiseAbs().maxCoeff(), 1e-12);
    }
}

// Of a barrier that was stiffer, or less so, than it is where the other one falls asleep.
TEST(SleepingBody, KeepsItsStiffnessWhereAnotherFallsAsleep) {
    Scene scene = two_cubes<3>(1);
    scene.solver.integrator = Integrator::NewtonEuler;
    scene.contact->model = ContactModel::Barrier;
    scene.sleep = Sleep{.speed = 1e-3, .time = 0.03};
    Simulation<3> simulation(scene, {cube<3>(1), cube<3>(1)});
    Snapshot<3> snapshot = simulation.save();
    const double other = 3 * snapshot.contact_stiffness;
    snapshot.sleep[0] = {.is_asleep = true, .quiet_steps = 9, .contact_stiffness = other};
    simulation.restore(snapshot);
    for (int i = 0; i < 6; ++i) {
        ASSERT_TRUE(simulation.step().is_accepted);
    }
    EXPECT_TRUE(simulation.sleep()[1].is_asleep);
    EXPECT_EQ(simulation.sleep()[1].contact_stiffness, snapshot.contact_stiffness);
    EXPECT_EQ(simulation.sleep()[0], snapshot.sleep[0]);
}

TEST(SleepingBody, DoesNotHinderThoseFarAway) {
    Scene scene = two_cubes<3>(5);
    scene.bodies[1].velocity = Eigen::Vector3d(0, 0, 1);
    scene.sleep = Sleep{.speed = 1e-3, .time = 0.02};
    Simulation<3> simulation(scene, {cube<3>(1), cube<3>(2)});
    const StepReport first = simulation.step();
    EXPECT_EQ(first.unknowns, 3 * (8 + 27));
    EXPECT_EQ(first.hessians, 6 * (1 + 8));  // Kuhn simplices in a cell
    EXPECT_EQ(simulation.step().asleep, 1);
    const StepReport later = simulation.step();
    EXPECT_EQ(later.unknowns, 3 * 27);
    EXPECT_EQ(later.hessians, 6 * 8);
    EXPECT_NEAR(simulation.velocities(1)(2, 5), 1, 1e-4);
}

// The end of a bar begins to turn at t = 0.3 s; until then nothing moves.
TEST(SleepingBody, WakesWhenItsConstraintMoves) {
    Scene scene = test::box_scene<4>();
    solve_tightly(scene);
    Motion turn = test::still(4);
    turn.rotate = {{.plane = {0, 3}, .degrees_per_s = 40}};
    turn.from = 0.3;
    scene.constraints = {
        test::hold(HalfSpaceSelection{.normal = Eigen::Vector4d(1, 0, 0, 0), .offset = 0.3}, turn)};
    Simulation<4> awake(scene, {test::bar(3)});
    scene.sleep = Sleep{.speed = 1e-3, .time = 0.1};
    Simulation<4> simulation(scene, {test::bar(3)});
    bool has_slept = false;
    for (int i = 0; i < 15; ++i) {
        has_slept = simulation.step().asleep == 1 || has_slept;
        static_cast<void>(awake.step());
    }
    EXPECT_TRUE(has_slept);
    EXPECT_FALSE(simulation.sleep()[0].is_asleep);
    EXPECT_LT((simulation.positions(0) - awake.positions(0)).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_GT((simulation.positions(0) - simulation.mesh(0).positions).cwiseAbs().maxCoeff(), 0.01);
}

class SleepingBodyInTheWay : public testing::TestWithParam<ContactModel> {};
INSTANTIATE_TEST_SUITE_P(All,
                         SleepingBodyInTheWay,
                         testing::Values(ContactModel::Penalty, ContactModel::Barrier));

// A body that is held everywhere comes down on one that sleeps: nothing else has unknowns.
TEST_P(SleepingBodyInTheWay, WakesWhenAHeldBodyTouchesIt) {
    Scene scene = two_cubes<3>(0.2);
    scene.contact->model = GetParam();
    scene.solver.integrator = Integrator::NewtonEuler;
    Motion down = test::still(3);
    down.translate[1] = -1;
    scene.constraints = {{.body = "b", .select = {EverythingSelection{}}, .motion = {down}}};
    scene.sleep = Sleep{.speed = 1e-3, .time = 0.05};
    Simulation<3> simulation(scene, {cube<3>(1), cube<3>(1)});
    bool has_slept = false;
    for (int i = 0; i < 60; ++i) {
        const StepReport report = simulation.step();
        ASSERT_TRUE(report.is_accepted) << report.failure;
        has_slept = has_slept || (report.asleep == 1 && report.unknowns == 0);
    }
    EXPECT_TRUE(has_slept);
    EXPECT_LT(test::mean_velocity(simulation, 0)[1], -0.5);  // pushed along
}

TEST(SleepingBody, IsTheSameToTheBitForAnyNumberOfThreads) {
    std::vector<Positions<3>> ends;
    for (const int threads : {1, 3}) {
        Simulation<3> simulation(stack(), {cube<3>(), cube<3>()}, {.threads = threads});
        test::throw_up(simulation, 1, 0.5);
        for (int i = 0; i < 80; ++i) {
            static_cast<void>(simulation.step());
        }
        ends.push_back(simulation.positions(1));
    }
    EXPECT_EQ(ends[0], ends[1]);
}

TEST(Restore, RefusesSleepThatDoesNotFitTheScene) {
    Scene scene = cube_on_floor<3>();
    Simulation<3> simulation(scene, {cube<3>(1)});
    Snapshot<3> snapshot = simulation.save();
    snapshot.sleep = {{.is_asleep = true, .quiet_steps = 9}};
    EXPECT_NO_THROW(simulation.restore(snapshot));
    EXPECT_EQ(simulation.step().unknowns, 0);
    scene.sleep.reset();
    Simulation<3> without(scene, {cube<3>(1)});
    EXPECT_ANY_THROW(without.restore(snapshot));
    snapshot.sleep.clear();
    EXPECT_ANY_THROW(simulation.restore(snapshot));
}

// A body that sleeps, and is put back to where it slept before, has the forces of there.
template <int Dim>
void expect_forces_of_where_it_sleeps() {
    const Scene scene = cube_on_floor<Dim>();
    Scene awake = scene;
    awake.sleep.reset();
    Simulation<Dim> simulation(scene, {cube<Dim>(1)});
    Simulation<Dim> without(awake, {cube<Dim>(1)});
    Snapshot<Dim> snapshot = simulation.save();
    const Positions<Dim> rest = snapshot.positions;
    for (const double stretch : {1.1, 0.9, 1.1}) {
        snapshot.positions = stretch * rest;
        snapshot.sleep = {{.is_asleep = true, .quiet_steps = 9}};
        simulation.restore(snapshot);
        Snapshot<Dim> other = snapshot;
        other.sleep = {{}};
        without.restore(other);
        EXPECT_GT(without.energies().of("elastic"), 0);
        // But for the order in which they are added up.
        const Positions<Dim> forces = without.forces(0);
        EXPECT_EQ(simulation.energies().of("elastic"), without.energies().of("elastic"));
        EXPECT_LT((simulation.forces(0) - forces).norm(), 1e-13 * forces.norm()) << stretch;
    }
}

TEST(Restore, PutsSleepersToWhereTheySleptWithTheForcesOfThere) {
    expect_forces_of_where_it_sleeps<3>();
    expect_forces_of_where_it_sleeps<4>();
}

// Stiffness of a barrier alone: without one there is none to put back.
TEST(Restore, RefusesStiffnessThatNoBarrierHas) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    for (const ContactModel model : {ContactModel::Penalty, ContactModel::Barrier}) {
        Scene scene = two_cubes<3>(0.1);
        scene.solver.integrator = Integrator::NewtonEuler;
        scene.sleep = Sleep{};
        scene.contact->model = model;
        Simulation<3> simulation(scene, {cube<3>(1), cube<3>(1)});
        const Snapshot<3> good = simulation.save();
        EXPECT_EQ(good.contact_stiffness > 0, model == ContactModel::Barrier);
        EXPECT_NO_THROW(simulation.restore(good));
        std::vector<Snapshot<3>> bad(4, good);
        bad[0].contact_stiffness = kNone;
        bad[1].contact_stiffness = -5;
        bad[2].sleep[1].contact_stiffness = kNone;
        bad[3].contact_stiffness = model == ContactModel::Barrier ? 0 : -1;
        for (const Snapshot<3>& snapshot : bad) {
            pent::test::expect_contains(
                pent::test::error_of([&] { simulation.restore(snapshot); }),
                {"a contact stiffness of ", " N/m was given; expected a finite one "});
        }
        EXPECT_EQ(simulation.save().contact_stiffness, good.contact_stiffness);
    }
}

TEST(Sleep, IsRefusedWhereNothingMoves) {
    Scene scene = cube_on_floor<3>();
    scene.constraints = {test::hold(EverythingSelection{}, test::still(3))};
    scene.solver.integrator = Integrator::Quasistatic;
    pent::test::expect_contains(pent::test::error_of([&] { check(scene); }),
                                {"quasistatic", "[sleep]"});
}

// A body that falls asleep is laid out anew, and so are those that stay awake.
template <int Dim>
void expect_momentum_of_bodies_that_meet_and_sleep(ElementKind elements) {
    Scene scene = two_cubes<Dim>(0.1);
    scene.solver.elements = elements;
    scene.bodies[0].velocity = Eigen::VectorXd::Unit(Dim, 1) + 0.1 * Eigen::VectorXd::Unit(Dim, 2);
    scene.solver.precision = Precision::Double;
    scene.solver.tolerance = 1e-11;
    scene.sleep = Sleep{.speed = 0.01, .time = 0.02};
    const SimplexMesh<Dim> mesh = test::cube_for<Dim>(scene, 2);
    Simulation<Dim> simulation(scene, {mesh, mesh});
    const Eigen::Matrix<double, Dim, 1> before = test::momentum(simulation);
    std::int64_t pairs = 0;
    bool has_slept = false;
    for (int step = 0; step < 30; ++step) {
        const StepReport report = simulation.step();
        ASSERT_TRUE(report.is_accepted);
        pairs = std::max(pairs, report.contact.point_facet + report.contact.mixed);
        has_slept = has_slept || report.asleep > 0;
    }
    EXPECT_TRUE(has_slept);  // the upper one, until it is hit
    EXPECT_GT(pairs, 0);
    EXPECT_LT((test::momentum(simulation) - before).norm(), 1e-8 * before.norm());
}

TEST(SleepingBody, OfAnyElementsKeepsItsMomentumWhereItIsHit) {
    for (const ElementKind elements :
         {ElementKind::Linear, ElementKind::Smoothed, ElementKind::Quadratic}) {
        SCOPED_TRACE(static_cast<int>(elements));
        expect_momentum_of_bodies_that_meet_and_sleep<3>(elements);
        expect_momentum_of_bodies_that_meet_and_sleep<4>(elements);
    }
}

}  // namespace
}  // namespace pent::simulator
