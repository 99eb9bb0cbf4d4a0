#include "contact_scenes.h"

#include <pent/contact/contact.h>

#include <gtest/gtest.h>

#include <support/host_tasks.h>
#include <utility>

// Contact in whole simulations: laws that hold for every integrator, in three and four dimensions.

namespace pent::simulator {
namespace {

using test::cube;
using test::hold;
using test::mean_velocity;
using test::momentum;
using test::still;
using test::throw_up;
using test::two_cubes;

template <typename T>
class ContactLaws : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(ContactLaws, Dimensions);

constexpr std::array kMoving = {Integrator::LinearEuler, Integrator::NewtonEuler, Integrator::Bdf2};

// The weights of a pair sum to zero, so its forces do: what is left is the residual of the linear
// solver, or the unbalanced force that Newton's method leaves, at a kink a few thousandths.
TYPED_TEST(ContactLaws, ConserveLinearMomentumOfFreeBodies) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : kMoving) {
        Scene scene = two_cubes<kDim>(0.06);
        scene.solver.integrator = integrator;
        scene.solver.precision = Precision::Double;
        scene.solver.tolerance = 1e-11;
        scene.solver.newton_tolerance = 1e-5;
        Simulation<kDim> simulation(scene, {cube<kDim>(), cube<kDim>()});
        throw_up(simulation, 0, 0.5);
        throw_up(simulation, 1, -1.0);
        const auto before = momentum(simulation);
        const bool is_linear = integrator == Integrator::LinearEuler;
        std::int64_t touched = 0;
        for (int i = 0; i < (is_linear ? 15 : 4); ++i) {
            const StepReport report = simulation.step();
            ASSERT_TRUE(report.is_accepted) << report.failure;
            touched += report.contact.point_facet + report.contact.mixed;
            ASSERT_LT((momentum(simulation) - before).norm(),
                      (is_linear ? 1e-8 : 5e-3) * before.norm())
                << i;
        }
        EXPECT_GT(touched, 20);
    }
}

TYPED_TEST(ContactLaws, LetBodiesThrownAtEachOtherSeparateAgain) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : kMoving) {
        Scene scene = two_cubes<kDim>(0.06);
        scene.solver.integrator = integrator;
        scene.bodies[0].material.density = scene.bodies[1].material.density = 100;
        Simulation<kDim> simulation(scene, {cube<kDim>(), cube<kDim>()});
        throw_up(simulation, 0, 0.5);
        throw_up(simulation, 1, -0.5);
        bool has_touched = false;
        StepReport report;
        for (int i = 0; i < 60; ++i) {
            report = simulation.step();
            ASSERT_TRUE(report.is_accepted) << report.failure;
            has_touched |= report.energies.of("contact") > 0;
            ASSERT_LT(report.contact.deepest, 0.05) << i;  // nowhere near half of a cube
        }
        EXPECT_TRUE(has_touched);
        EXPECT_EQ(report.contact.point_facet + report.contact.mixed, 0);
        // Apart again, and each turned back; implicit steps take some of the speed.
        EXPECT_GT(mean_velocity(simulation, 1)[1], 0.05);
        EXPECT_LT(mean_velocity(simulation, 0)[1], -0.05);
    }
}

// Positions of two cubes behind a glancing blow, Dim x vertices.
template <int Dim>
Positions<Dim> after_blow(Integrator integrator, int steps) {
    constexpr double kSeconds = 0.08;
    Scene scene = two_cubes<Dim>(-0.08);
    scene.bodies[1].place.rotate = {{.plane = {0, 2}, .degrees = 20},
                                    {.plane = {0, 1}, .degrees = 15},
                                    {.plane = {1, Dim - 1}, .degrees = 25}};
    scene.frames_per_second = steps / kSeconds;
    scene.solver.integrator = integrator;
    scene.solver.precision = Precision::Double;
    scene.solver.tolerance = 1e-8;
    scene.solver.newton_tolerance = 1e-8;
    Simulation<Dim> simulation(scene, {cube<Dim>(1), cube<Dim>(1)});
    throw_up(simulation, 0, 0.5);
    throw_up(simulation, 1, -0.5);
    std::int64_t touched = 0;
    for (int step = 0; step < steps; ++step) {
        const StepReport report = simulation.step();
        EXPECT_TRUE(report.is_accepted);
        touched += report.contact.mixed;
    }
    EXPECT_GT(touched, steps / 8);
    Positions<Dim> positions(Dim, 2 * simulation.mesh(0).vertex_count());
    positions << simulation.positions(0), simulation.positions(1);
    return positions;
}

// One model of contact for all integrators: what parts them falls with the step.
TYPED_TEST(ContactLaws, LeadEveryIntegratorToTheSameMotion) {
    constexpr int kDim = TypeParam::value;
    constexpr int kSteps = 64;
    const Positions<kDim> exact = after_blow<kDim>(Integrator::Bdf2, 4 * kSteps);
    const auto error = [&](Integrator integrator, int steps) {
        return (after_blow<kDim>(integrator, steps) - exact).norm();
    };
    for (const Integrator integrator : {Integrator::LinearEuler, Integrator::NewtonEuler}) {
        const double coarse = error(integrator, kSteps);
        const double fine = error(integrator, 4 * kSteps);
        // First order is a quarter, less what higher terms take where contacts last for few steps.
        EXPECT_GT(coarse, 2 * fine);
        EXPECT_LT(coarse, 4.5 * fine);
    }
}

// Dropped from 0.1 m, with damping: at rest the floor carries the weight, and all stays where it
// is.
TYPED_TEST(ContactLaws, BringADroppedBodyToRestOnTheFloor) {
    constexpr int kDim = TypeParam::value;
    Scene scene = test::box_scene<kDim>();
    scene.frames_per_second = 60;
    scene.gravity[1] = -9.8;
    scene.bodies[0].place.translate[1] = 0.1;
    scene.obstacles = {
        {.shape = HalfSpaceObstacle{.normal = Eigen::VectorXd::Unit(kDim, 1), .offset = 0},
         .distance = 0.02,
         .stiffness = 1e4}};
    scene.damping = Damping{.mass = 3, .stiffness = 0.01};
    Simulation<kDim> simulation(scene, {cube<kDim>()});
    StepReport report;
    for (int i = 0; i < 240; ++i) {
        report = simulation.step();
        ASSERT_TRUE(report.is_accepted);
        ASSERT_GT(simulation.positions(0).row(1).minCoeff(), -0.02) << i;
    }
    EXPECT_LT(simulation.velocities(0).cwiseAbs().maxCoeff(), 1e-4);
    const double weight = 9.8 * simulation.masses(0).sum();
    EXPECT_NEAR(simulation.contact_forces(0).row(1).sum(), weight, 1e-3 * weight);
    EXPECT_GT(report.contact.obstacle, 0);
    EXPECT_GT(report.energies.of("obstacle"), 0);
    const Positions<kDim> rested = simulation.positions(0);
    for (int i = 0; i < 60; ++i) {
        ASSERT_TRUE(simulation.step().is_accepted);
    }
    EXPECT_LT((simulation.positions(0) - rested).cwiseAbs().maxCoeff(), 1e-4);
}

// Two bodies one upon the other in a bowl of 0.8 m: nothing ever leaves it, and in the end all
// rests.
TYPED_TEST(ContactLaws, KeepEverythingInTheBowlAndBringItToRest) {
    constexpr int kDim = TypeParam::value;
    Scene scene = two_cubes<kDim>(0.1);
    scene.frames_per_second = 60;
    scene.gravity[1] = -9.8;
    for (Body& body : scene.bodies) {
        body.place.scale = 0.6;
        body.place.translate.array() -= 0.1;
    }
    scene.bodies[1].place.translate[1] -= 0.2;
    scene.contact->distance = 0.03;
    scene.contact->stiffness = 1e4;
    scene.damping = Damping{.mass = 3, .stiffness = 0.01};
    const Eigen::VectorXd center = 0.2 * Eigen::VectorXd::Unit(kDim, 1);
    scene.obstacles = {
        {.shape =
             BowlObstacle{.center = center, .radius = 0.8, .up = Eigen::VectorXd::Unit(kDim, 1)},
         .distance = 0.03,
         .stiffness = 1e4}};
    Simulation<kDim> simulation(scene, {cube<kDim>(), cube<kDim>()});
    std::int64_t touched = 0;
    for (int i = 0; i < 400; ++i) {
        const StepReport report = simulation.step();
        ASSERT_TRUE(report.is_accepted) << i << report.failure;
        touched += report.contact.mixed + report.contact.point_facet;
        for (int body = 0; body < 2; ++body) {
            const auto from_center = simulation.positions(body).colwise() - center;
            ASSERT_LT(from_center.colwise().norm().maxCoeff(), 0.8) << i;
        }
    }
    EXPECT_GT(touched, 0);
    for (int body = 0; body < 2; ++body) {
        // A frictionless bowl is a pendulum that only damping stops: exp(-3/2 * 6.7 s) of its
        // start.
        EXPECT_LT(simulation.velocities(body).cwiseAbs().maxCoeff(), 5e-3);
    }
}

// Nothing pulls, but it is thrown: it bounces about and stays within.
TYPED_TEST(ContactLaws, KeepABodyInItsCavity) {
    constexpr int kDim = TypeParam::value;
    Scene scene = two_cubes<kDim>(0.1);
    scene.bodies.pop_back();
    scene.frames_per_second = 60;
    const Eigen::VectorXd middle = cube<kDim>().positions.rowwise().mean();
    scene.bodies[0].velocity = 3 * Eigen::VectorXd::Unit(kDim, 1);
    const double radius =
        1.5 * (cube<kDim>().positions.colwise() - middle).colwise().norm().maxCoeff();
    scene.obstacles = {{.shape = CavityObstacle{.center = middle, .radius = radius},
                        .distance = 0.05,
                        .stiffness = 1e5}};
    Simulation<kDim> simulation(scene, {cube<kDim>()});
    int bounces = 0;
    bool rose = true;
    for (int i = 0; i < 120; ++i) {
        ASSERT_TRUE(simulation.step().is_accepted);
        ASSERT_LT((simulation.positions(0).colwise() - middle).colwise().norm().maxCoeff(), radius);
        const bool rises = mean_velocity(simulation, 0)[1] > 0;
        bounces += rises != rose ? 1 : 0;
        rose = rises;
    }
    EXPECT_GE(bounces, 2);
}

TYPED_TEST(ContactLaws, LetAHeldMeshPushAFreeBody) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : kMoving) {
        Scene scene = two_cubes<kDim>(0.06);
        scene.solver.integrator = integrator;
        Motion rise = still(kDim);
        rise.translate[1] = 0.5;
        scene.constraints = {{.body = "a", .select = {EverythingSelection{}}, .motion = {rise}}};
        Simulation<kDim> simulation(scene, {cube<kDim>(), cube<kDim>()});
        for (int i = 0; i < 30; ++i) {
            const StepReport report = simulation.step();
            ASSERT_TRUE(report.is_accepted) << report.failure;
            ASSERT_LT(report.contact.deepest, 0.05);
        }
        // It is never slower than what pushes it, once that has reached it.
        EXPECT_GT(mean_velocity(simulation, 1)[1], 0.45);
    }
}

// A coarse cube that falls askew on a finer one: edges of both are nearly parallel where they meet,
// turn past each other as it comes to rest, and are most of what bears it.
TYPED_TEST(ContactLaws, BearACubeOnNearlyParallelEdgesInFewIterations) {
    constexpr int kDim = TypeParam::value;
    for (const double degrees : {1e-4, 0.6}) {
        Scene scene = test::box_scene<kDim>();
        scene.gravity[1] = -9.8;
        scene.solver.integrator = Integrator::NewtonEuler;
        scene.damping = Damping{.mass = 5};
        scene.contact = ContactSettings{};
        scene.bodies.push_back(scene.bodies[0]);
        scene.bodies[0].name = "a";
        scene.bodies[0].place.translate.setConstant(-0.1);
        scene.bodies[1].name = "b";
        scene.bodies[1].place.translate.setConstant(-0.1);
        scene.bodies[1].place.translate.head(3) += Eigen::Vector3d(0.02, 0.23, 0.01);
        scene.bodies[1].place.rotate = {{.plane = {1, 0}, .degrees = degrees},
                                        {.plane = {1, kDim - 1}, .degrees = degrees / 2}};
        scene.constraints = {
            {.body = "a", .select = {EverythingSelection{}}, .motion = {still(kDim)}}};
        std::array<double, kDim> size{};
        size.fill(0.2);
        std::array<int, kDim> one{};
        one.fill(1);
        std::array<int, kDim> two{};
        two.fill(2);
        Simulation<kDim> simulation(
            scene, {pent::test::kuhn_box<kDim>(two, size), pent::test::kuhn_box<kDim>(one, size)});
        int iterations = 0;
        std::int64_t mixed = 0;
        constexpr int kSteps = 60;
        for (int step = 0; step < kSteps; ++step) {
            const StepReport report = simulation.step();
            ASSERT_TRUE(report.is_accepted) << step << ": " << report.failure;
            EXPECT_EQ(report.refused, 0) << step;
            ASSERT_LT(report.contact.deepest, 0.02) << step;
            iterations += report.newton_iterations;
            mixed += report.contact.mixed;
        }
        EXPECT_LT(iterations, 10 * kSteps);  // eight of them to see that it goes in circles
        EXPECT_GT(mixed, 5 * kSteps);
    }
}

// One body of two cubes: it meets itself only where the scene says so.
TYPED_TEST(ContactLaws, KeepABodyOutOfItselfWhereAsked) {
    constexpr int kDim = TypeParam::value;
    SimplexMesh<kDim> mesh = cube<kDim>();
    const Eigen::Index half = mesh.vertex_count();
    const Positions<kDim> low = mesh.positions;
    const auto cells = mesh.cells;
    mesh.positions.resize(kDim, 2 * half);
    mesh.positions << low, low.array() + 0.04;
    mesh.positions.rightCols(half).row(1).array() += 0.57;
    mesh.cells.resize(kDim + 1, 2 * cells.cols());
    mesh.cells << cells, cells.array() + static_cast<std::uint32_t>(half);
    for (const bool self : {false, true}) {
        Scene scene = test::box_scene<kDim>();
        scene.frames_per_second = 100;
        scene.contact = ContactSettings{.distance = 0.05, .stiffness = 2e3, .self = self};
        Simulation<kDim> simulation(scene, {mesh});
        Positions<kDim> velocities = Positions<kDim>::Zero(kDim, 2 * half);
        velocities.row(1).leftCols(half).setConstant(0.3);
        velocities.row(1).rightCols(half).setConstant(-0.3);
        simulation.set_state(0, simulation.positions(0), velocities);
        double deepest = 0;
        std::int64_t touched = 0;
        for (int i = 0; i < 60; ++i) {
            const StepReport report = simulation.step();
            ASSERT_TRUE(report.is_accepted);
            deepest =
                std::max(deepest, simulation.positions(0).row(1).leftCols(half).maxCoeff()
                                      - simulation.positions(0).row(1).rightCols(half).minCoeff());
            touched += report.contact.self;
            EXPECT_EQ(report.contact.self, report.contact.point_facet + report.contact.mixed);
        }
        EXPECT_EQ(touched > 0, self);
        EXPECT_EQ(deepest > 0.05, !self) << deepest;
    }
}

TEST(NoContact, BuildsNoTreeSearchesNothingAndTakesNoMemory) {
    Scene scene = two_cubes<4>(0.01);
    scene.contact.reset();
    Simulation<4> simulation(scene, {cube<4>(), cube<4>()});
    EXPECT_EQ(simulation.size().contact_bytes, 0);
    const StepReport report = simulation.step();
    EXPECT_EQ(report.contact.searches, 0);
    EXPECT_EQ(report.contact.trees_built, 0);
    EXPECT_EQ(report.contact.trees_refit, 0);
    EXPECT_EQ(report.contact.candidates, 0);
    EXPECT_EQ(report.contact.seconds, 0);
    EXPECT_EQ(report.energies.of("contact"), 0);
    EXPECT_TRUE(simulation.contacts().empty());
}

TEST(NoContact, CostsNothingForOneBodyThatDoesNotMeetItself) {
    Scene scene = test::box_scene<4>();
    scene.contact = ContactSettings{};
    Simulation<4> simulation(scene, {cube<4>()});
    EXPECT_EQ(simulation.size().contact_bytes, 0);
    EXPECT_EQ(simulation.step().contact.searches, 0);
}

TEST(ContactOfALinearStep, IsSearchedOnceAStepAndItsTreesAreRefit) {
    Simulation<4> simulation(two_cubes<4>(0.01), {cube<4>(), cube<4>()});
    EXPECT_GT(simulation.size().contact_bytes, 0);
    static_cast<void>(simulation.step());
    const StepReport report = simulation.step();
    EXPECT_EQ(report.contact.searches, 1);
    EXPECT_EQ(report.contact.trees_built, 0);
    // Of two bodies: patches of vertices, edges, triangles and tetrahedra, and trees of vertices
    // and of facets, which tell what is inside.
    EXPECT_EQ(report.contact.trees_refit, 12);
    EXPECT_GT(report.contact.candidates, 0);
}

TEST(HeldBodies, DoNotMeetEachOther) {
    Scene scene = two_cubes<4>(0.01);
    for (const char* name : {"a", "b"}) {
        scene.constraints.push_back(
            {.body = name, .select = {EverythingSelection{}}, .motion = {}});
    }
    Simulation<4> simulation(scene, {cube<4>(), cube<4>()});
    EXPECT_TRUE(simulation.step().is_accepted);
    EXPECT_TRUE(simulation.contacts().empty());
}

// All bits of the positions and velocities of two bodies pressed together, after some steps.
std::vector<double> state_after(int steps, TaskSystem tasks, Integrator integrator) {
    Scene scene = two_cubes<4>(0.02);
    scene.solver.integrator = integrator;
    const SimplexMesh<4> slab = integrator == Integrator::LinearEuler
                                    ? pent::test::kuhn_box<4>({5, 2, 5, 4}, {1.25, 0.5, 1.25, 1})
                                    : cube<4>();
    Simulation<4> simulation(scene, {slab, slab}, {.tasks = std::move(tasks)});
    throw_up(simulation, 0, 0.5);
    throw_up(simulation, 1, -0.5);
    std::vector<double> state;
    for (int i = 0; i < steps; ++i) {
        const StepReport report = simulation.step();
        EXPECT_TRUE(report.is_accepted) << report.failure;
        EXPECT_GT(report.contact.mixed, 50);
    }
    for (int body = 0; body < 2; ++body) {
        const Positions<4> forces = simulation.contact_forces(body);
        for (const auto& values : {Positions<4>(simulation.positions(body)),
                                   Positions<4>(simulation.velocities(body)), forces}) {
            state.insert(state.end(), values.data(), values.data() + values.size());
        }
    }
    return state;
}

void expect_the_same_for_any_number_of_threads(int steps, Integrator integrator) {
    const std::vector<double> one = state_after(steps, own_task_system(1), integrator);
    EXPECT_EQ(state_after(steps, own_task_system(2), integrator), one);
    for (const int threads : {2, 3, 8}) {
        EXPECT_EQ(state_after(steps, pent::test::host_tasks(threads), integrator), one)
            << threads << " threads of a host";
    }
}

TEST(ContactInASimulation, IsTheSameToTheBitForAnyNumberOfThreads) {
    expect_the_same_for_any_number_of_threads(2, Integrator::LinearEuler);
}

TEST(ContactInANewtonStep, IsTheSameToTheBitForAnyNumberOfThreads) {
    expect_the_same_for_any_number_of_threads(1, Integrator::NewtonEuler);
}

TEST(ContactForces, AreThoseOfThePairsAndSumToZero) {
    Simulation<4> simulation(two_cubes<4>(0.01), {cube<4>(), cube<4>()});
    static_cast<void>(simulation.step());
    Positions<4> forces(4, 2 * simulation.mesh(0).vertex_count());
    forces << simulation.contact_forces(0), simulation.contact_forces(1);
    const double size = forces.norm();
    EXPECT_GT(size, 0);
    EXPECT_LT(forces.rowwise().sum().norm(), 1e-12 * size);
    for (const contact::Contact<4>& contact : simulation.contacts()) {
        for (int i = 0; i <= 4; ++i) {
            forces.col(contact.vertices[i]) -= contact.force(i);
        }
    }
    EXPECT_LT(forces.norm(), 1e-12 * size);
}

// A step that asks for more contact distance than the meshes bear says so.
TEST(ContactWarnings, NameTheSettingAndTheBody) {
    Scene scene = two_cubes<4>(0.5);
    scene.contact->distance = 0.3;
    const Simulation<4> simulation(scene, {cube<4>(), cube<4>()});
    ASSERT_EQ(simulation.warnings().size(), 2U);
    EXPECT_NE(simulation.warnings()[1].find("distance"), std::string::npos);
    EXPECT_NE(simulation.warnings()[1].find("'b'"), std::string::npos);
}

}  // namespace
}  // namespace pent::simulator
