#include "host_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

// Attempts at a step: when one fails, and what becomes of it.

namespace pent::simulator {
namespace {

using test::bar;
using test::box_scene;
using test::Dimensions;
using test::expect_same;
using test::kWithInertia;
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

template <int Dim>
void expect_same_but_for_sleep(const Snapshot<Dim>& a, const Snapshot<Dim>& b) {
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.velocities, b.velocities);
    EXPECT_EQ(a.previous_positions, b.previous_positions);
    EXPECT_EQ(a.previous_velocities, b.previous_velocities);
    EXPECT_EQ(a.steps, b.steps);
    EXPECT_EQ(a.contact_stiffness, b.contact_stiffness);
    EXPECT_EQ(a.broken_springs, b.broken_springs);
}

// In the second half of the fifth step held vertices go farther than any scene allows: the first
// half, which was taken, is given back, though things have met and bounced in it.
template <int Dim>
void expect_all_given_back(Integrator integrator, ContactModel model) {
    Scene scene = test::two_cubes<Dim>(0.01);
    scene.gravity[1] = -9.8;
    scene.solver.integrator = integrator;
    scene.solver.max_halvings = 1;
    scene.contact->model = model;
    scene.contact->stiffness = 1;  // so little that a barrier raises it
    scene.bodies[1].velocity = -Eigen::VectorXd::Unit(Dim, 1);
    Motion away = test::still(Dim);
    away.translate[0] = 1e9;
    away.from = 4.5 * scene.dt();
    scene.constraints = {
        {.body = "a",
         .select = {HalfSpaceSelection{.normal = Eigen::VectorXd::Unit(Dim, 1), .offset = 1e-6}},
         .motion = {away}}};
    Simulation<Dim> simulation(scene, {test::cube<Dim>(1), test::cube<Dim>(1)});
    for (int i = 0; i < 4; ++i) {
        test::take_step(simulation);
    }
    const Snapshot<Dim> before = simulation.save();
    const StepReport report = simulation.step();
    EXPECT_FALSE(report.is_accepted);
    EXPECT_EQ(report.substeps, 1);
    expect_same_but_for_sleep(simulation.save(), before);
}

TEST(FailedStep, GivesBackWhatItsFirstHalfDid) {
    for (const Integrator integrator : kWithInertia) {
        SCOPED_TRACE(static_cast<int>(integrator));
        expect_all_given_back<3>(integrator, ContactModel::Penalty);
        if (integrator != Integrator::LinearEuler) {
            expect_all_given_back<3>(integrator, ContactModel::Barrier);
        }
    }
    expect_all_given_back<4>(Integrator::Bdf2, ContactModel::Penalty);
    expect_all_given_back<4>(Integrator::Bdf2, ContactModel::Barrier);
}

// Forces are those of the state that a step comes back to: the first half of it was taken, and
// walls of pressure were held where that led to.
template <int Dim>
void expect_forces_of_the_start() {
    const SimplexMesh<Dim> cube = test::cube<Dim>(1);
    const Eigen::VectorXd up = Eigen::VectorXd::Unit(Dim, 1);
    Scene scene = test::box_scene<Dim>();
    scene.gravity = -9.8 * up;
    scene.solver.integrator = Integrator::NewtonEuler;
    scene.solver.max_halvings = 1;
    Motion away = test::still(Dim);
    away.translate[0] = 1e9;
    away.from = 4.5 * scene.dt();
    scene.constraints = {{.body = "box",
                          .select = {HalfSpaceSelection{.normal = up, .offset = 1e-6}},
                          .motion = {away}}};
    const double top = cube.positions.row(1).maxCoeff();
    scene.loads = {{.body = "box",
                    .select = {HalfSpaceSelection{.normal = -up, .offset = 1e-6 - top}},
                    .force = {},
                    .pressure = 1e4,
                    .keyframes = {}}};
    Simulation<Dim> simulation(scene, {cube});
    for (int i = 0; i < 4; ++i) {
        test::take_step(simulation);
    }
    const StepReport report = simulation.step();
    EXPECT_FALSE(report.is_accepted);
    EXPECT_EQ(report.substeps, 1);
    const Positions<Dim> forces = simulation.forces(0);
    simulation.restore(simulation.save());
    EXPECT_LT((simulation.forces(0) - forces).norm(), 1e-9 * forces.norm());
}

TEST(FailedStep, LeavesTheForcesOfItsStart) {
    expect_forces_of_the_start<3>();
    expect_forces_of_the_start<4>();
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

// The same of a damped step, which linear_euler takes where its own would go astray.
TEST(DampedStep, NeverEndsAboveWhereTheStepBegan) {
    int damped = 0;
    for (const double frames_per_second : {100.0, 30.0}) {
        for (const double speed : {1e2, 3e2, 1e3, 3e3, 1e4}) {
            Scene scene = box_scene<4>();
            scene.frames_per_second = frames_per_second;
            Simulation<4> simulation(scene, {bar(3)});
            Positions<4> velocities = simulation.velocities(0);
            velocities(0, 0) = speed;  // of one corner
            simulation.set_state(0, simulation.positions(0), velocities);
            const double before = simulation.energies().kinetic;
            const StepReport report = simulation.step();
            ASSERT_TRUE(report.is_accepted) << report.failure;
            if (report.damped == 0) {
                continue;
            }
            damped += report.damped;
            EXPECT_EQ(report.substeps, 1) << frames_per_second << ' ' << speed;
            EXPECT_EQ(report.refused, 1) << frames_per_second << ' ' << speed;
            EXPECT_NE(report.failure, "");
            EXPECT_LE(kinetic_energy(simulation, velocities) + report.energies.of("elastic"),
                      before)
                << frames_per_second << ' ' << speed;
        }
    }
    EXPECT_GT(damped, 2);
}

TEST(DampedStep, IsNoneOfAMotionThatIsNotInTrouble) {
    Simulation<4> simulation(swinging_bar(), {bar()});
    for (int i = 0; i < 20; ++i) {
        const StepReport report = simulation.step();
        ASSERT_TRUE(report.is_accepted) << report.failure;
        EXPECT_EQ(report.damped, 0);
        EXPECT_EQ(report.refused, 0);
        EXPECT_EQ(report.newton_iterations, 0);
    }
}

TEST(DampedStep, DoesNotSaveWhatIsBeyondAllNumbers) {
    Scene scene = box_scene<4>();
    scene.solver.max_halvings = 2;
    Simulation<4> simulation(scene, {bar(2)});
    const Positions<4> before = simulation.positions(0);
    Positions<4> velocities = Positions<4>::Zero(4, before.cols());
    velocities(0, 0) = 1e100;
    simulation.set_state(0, before, velocities);
    const StepReport report = simulation.step();
    EXPECT_FALSE(report.is_accepted);
    EXPECT_EQ(report.failure, "the motion grew beyond all bounds");
    EXPECT_EQ(simulation.positions(0), before);
}

template <typename T>
class HardPull : public testing::Test {};
TYPED_TEST_SUITE(HardPull, Dimensions);

// A cube that stands on the ground by its lowest vertices, in steps of 10 ms.
template <int Dim>
struct StandingCube {
    Scene scene = box_scene<Dim>();
    SimplexMesh<Dim> mesh;

    StandingCube(Integrator integrator, ElementKind elements) {
        scene.frames_per_second = 100;
        scene.solver.integrator = integrator;
        scene.solver.elements = elements;
        scene.gravity[1] = -9.8;
        scene.damping = Damping{.mass = 5, .stiffness = 0.01};
        const Eigen::VectorXd up = Eigen::VectorXd::Unit(Dim, 1);
        scene.constraints = {
            test::hold(HalfSpaceSelection{.normal = up, .offset = 1e-6}, test::still(Dim))};
        mesh = elements == ElementKind::Quadratic ? test::quadratic_cube<Dim>(1, 0.5)
                                                  : test::cube<Dim>(2);
    }
};

// Takes hold of the highest corner, by its vertex or by a spring without a bound, and takes that so
// far away, m, in one step.
template <int Dim>
void pull(Simulation<Dim>& simulation, bool by_grab, double far) {
    Grab<Dim> grab = test::corner(simulation, 0, 20000);
    grab.anchor[Dim - 1] += far;
    grab.max_force = 1e30;
    if (by_grab) {
        static_cast<void>(simulation.add_grab(grab));
        return;
    }
    Eigen::Index vertex = 0;
    simulation.mesh(0).positions.colwise().sum().maxCoeff(&vertex);
    simulation.set_targets(0, {static_cast<std::uint32_t>(vertex)}, grab.anchor);
}

template <int Dim>
void let_go(Simulation<Dim>& simulation) {
    for (const auto& holding : simulation.host().grabs) {
        simulation.remove_grab(holding.id);
    }
    simulation.release(0, simulation.host().held);
}

// Every step is taken, at the price of a few: of the one that went astray and one more, or of
// halves.
template <int Dim>
void expect_recovery(const StandingCube<Dim>& cube, bool by_grab) {
    Simulation<Dim> simulation(cube.scene, {cube.mesh});
    StepReport report;
    const auto run = [&](int steps) {
        for (int i = 0; i < steps; ++i) {
            report = simulation.step();
            ASSERT_TRUE(report.is_accepted) << i << ": " << report.failure;
            EXPECT_LE(report.substeps + report.refused, 7) << i;
            if (cube.scene.solver.integrator == Integrator::LinearEuler) {
                EXPECT_LE(report.newton_iterations, 4 * report.substeps) << i;
            }
        }
    };
    run(100);  // to rest
    const Positions<Dim> before = simulation.positions(0);
    const double far = 30;  // m: sixty times the size
    pull(simulation, by_grab, far);
    run(3);
    EXPECT_GT((simulation.positions(0) - before).cwiseAbs().maxCoeff(), far / 2);
    let_go(simulation);
    // Of forty pulls of 28 to 34 m, by a spring and by the vertex, one or two leave quadratic cells
    // that are still unfolding after 300 steps, in floats as in doubles; all rest after 600.
    const double at_rest = 1e-3;  // J
    int runs = 0;
    do {
        run(300);
    } while (++runs < 3 && report.energies.kinetic > at_rest);
    EXPECT_LT(report.energies.kinetic, at_rest);
    // e^(-5 t / 2) of 30 m is 2 cm if nothing else damps it. Turned inside out a quadratic cell has
    // an equilibrium of its own, which the step reports.
    const bool is_back = (simulation.positions(0) - before).cwiseAbs().maxCoeff() < 2e-2;
    const bool may_fold = cube.scene.solver.elements == ElementKind::Quadratic;
    EXPECT_TRUE(is_back || (may_fold && report.inverted > 0));
}

TYPED_TEST(HardPull, IsRecoveredFromInEveryIntegratorByTheVertexAndByASpring) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : kWithInertia) {
        for (const ElementKind elements : {ElementKind::Linear, ElementKind::Quadratic}) {
            for (const bool by_grab : {false, true}) {
                SCOPED_TRACE(std::to_string(static_cast<int>(integrator)) + ' '
                             + std::to_string(static_cast<int>(elements))
                             + (by_grab ? " by a spring" : " by the vertex"));
                expect_recovery<kDim>({integrator, elements}, by_grab);
            }
        }
    }
}

// Farther than that elements may be left inside out, but still no step is refused: those that find
// a state which is strained like this may have no linear solution at all.
TYPED_TEST(HardPull, RefusesNoLaterStepHoweverFarItWas) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind elements : {ElementKind::Linear, ElementKind::Quadratic}) {
        const StandingCube<kDim> cube(Integrator::LinearEuler, elements);
        Simulation<kDim> simulation(cube.scene, {cube.mesh});
        pull(simulation, false, 250);
        for (int i = 0; i < 40; ++i) {
            if (i == 3) {
                let_go(simulation);
            }
            const StepReport report = simulation.step();
            ASSERT_TRUE(report.is_accepted) << i << ": " << report.failure;
        }
    }
}

// Steps that are damped, too, go on from a saved state as they were, for any number of threads.
TYPED_TEST(HardPull, GoesOnToTheBitFromEveryState) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : kWithInertia) {
        const StandingCube<kDim> cube(integrator, ElementKind::Linear);
        Simulation<kDim> whole(cube.scene, {cube.mesh}, {.threads = 3});
        Simulation<kDim> two(cube.scene, {cube.mesh}, {.threads = 2});
        Simulation<kDim> often(cube.scene, {cube.mesh});
        int damped = 0;
        for (int i = 0; i < 12; ++i) {
            for (Simulation<kDim>* simulation : {&whole, &two, &often}) {
                if (i == 2) {
                    pull(*simulation, true, 100);
                } else if (i == 6) {
                    let_go(*simulation);
                }
                const StepReport report = simulation->step();
                ASSERT_TRUE(report.is_accepted) << i << ": " << report.failure;
                damped += report.damped;
            }
            expect_same(whole, often);
            expect_same(whole, two);
            Simulation<kDim> next(cube.scene, {cube.mesh});
            next.restore(often.save());
            often = std::move(next);
        }
        EXPECT_EQ(damped > 0, integrator == Integrator::LinearEuler);
    }
}

}  // namespace
}  // namespace pent::simulator
