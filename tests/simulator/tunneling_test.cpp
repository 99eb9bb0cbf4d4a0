#include "barrier_scenes.h"
#include "contact_scenes.h"
#include "support/messages.h"

#include <gtest/gtest.h>

// What is so fast that one step would take it to the far side of what is in its way.

namespace pent::simulator {
namespace {

using test::box;
using test::cube;
using test::mean_velocity;
using test::still;

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;

template <typename T>
class Tunneling : public testing::Test {};
TYPED_TEST_SUITE(Tunneling, Dimensions);

constexpr Integrator kIntegrators[] = {Integrator::LinearEuler, Integrator::NewtonEuler,
                                       Integrator::Bdf2};

// A cube of 0.25 m that flies at 60 m/s along x towards an obstacle around the origin, of 0.8 m. In
// steps of 1/30 s one end of a step is before it, and the other behind it.
template <int Dim>
Scene shot(const Obstacle& obstacle) {
    Scene scene = test::box_scene<Dim>();
    scene.frames_per_second = 30;
    scene.bodies[0].material.lame = lame_from_young(Dim, 1e7, 0.3);
    scene.bodies[0].place.translate = Eigen::VectorXd::Constant(Dim, -0.125);
    scene.bodies[0].place.translate[0] = -1.125;
    scene.bodies[0].velocity = 60 * Eigen::VectorXd::Unit(Dim, 0);
    scene.obstacles = {obstacle};
    scene.obstacles[0].distance = 0.02;
    scene.obstacles[0].stiffness = 1e6;
    return scene;
}

template <int Dim>
std::vector<Obstacle> obstacles_in_the_way() {
    return {{.shape = BallObstacle{.center = Eigen::VectorXd::Zero(Dim), .radius = 0.4}},
            {.shape = BoxObstacle{.center = Eigen::VectorXd::Zero(Dim),
                                  .sides = Eigen::VectorXd::Constant(Dim, 0.8)}}};
}

// What turns fast is not looked at for passing through what it may not touch.
TYPED_TEST(Tunneling, IsOfBodiesThatMayTouch) {
    constexpr int kDim = TypeParam::value;
    Scene scene = test::box_scene<kDim>();
    scene.frames_per_second = 30;
    scene.solver.integrator = Integrator::NewtonEuler;
    scene.solver.max_halvings = 0;
    scene.bodies[0].material.lame = lame_from_young(kDim, 1e6, 0.3);
    scene.bodies[0].spin = {{.plane = {0, 1}, .degrees_per_s = 1200}};
    const SimplexMesh<kDim> bar = box<kDim>(4, 1, 1, test::vector<kDim>(1, 0.1, 0.1));
    scene.contact = ContactSettings{.distance = 0.01, .friction = 0.3};
    scene.obstacles = {
        {.shape = HalfSpaceObstacle{.normal = Eigen::VectorXd::Unit(kDim, 1), .offset = -50}}};
    const auto failure = [&](std::size_t bodies) {
        Simulation<kDim> simulation(scene, std::vector<SimplexMesh<kDim>>(bodies, bar));
        return simulation.step().failure;
    };
    EXPECT_EQ(failure(1), "");
    scene.bodies.push_back(scene.bodies[0]);
    scene.bodies[1].name = "far";
    scene.bodies[1].place.translate[1] = 9;
    pent::test::expect_contains(failure(2), {"could pass through each other"});
    scene.contact->ignore = {{scene.bodies[0].name, "far"}};
    EXPECT_EQ(failure(2), "");
}

// It is thrown back, or at least has lost a tenth of its speed; where steps may not be cut, the run
// ends.
TYPED_TEST(Tunneling, ThroughAnObstacleIsSeenByPenalties) {
    constexpr int kDim = TypeParam::value;
    for (const Obstacle& obstacle : obstacles_in_the_way<kDim>()) {
        for (const Integrator integrator : kIntegrators) {
            Scene scene = shot<kDim>(obstacle);
            scene.solver.integrator = integrator;
            Simulation<kDim> simulation(scene, {cube<kDim>(1)});
            const StepReport report = simulation.step();
            ASSERT_TRUE(report.is_accepted) << report.failure;
            EXPECT_GT(report.refused, 0);
            EXPECT_LT(mean_velocity(simulation, 0)[0], 54);
            scene.solver.max_halvings = 0;
            Simulation<kDim> whole(scene, {cube<kDim>(1)});
            const StepReport refused = whole.step();
            EXPECT_FALSE(refused.is_accepted);
            pent::test::expect_contains(refused.failure,
                                        {"of 'box' goes through obstacle 1 in one step"});
        }
    }
}

// The same seen from the cube: it rests, and the obstacle comes.
TYPED_TEST(Tunneling, ThroughAnObstacleThatMovesIsSeenByPenalties) {
    constexpr int kDim = TypeParam::value;
    for (const Obstacle& obstacle : obstacles_in_the_way<kDim>()) {
        Scene scene = shot<kDim>(obstacle);
        scene.solver.max_halvings = 0;
        scene.bodies[0].velocity.setZero();
        scene.obstacles[0].motion = {still(kDim)};
        scene.obstacles[0].motion[0].translate[0] = -60;
        Simulation<kDim> simulation(scene, {cube<kDim>(1)});
        const StepReport report = simulation.step();
        EXPECT_FALSE(report.is_accepted);
        pent::test::expect_contains(report.failure,
                                    {"of 'box' goes through obstacle 1 in one step"});
    }
}

// Nothing is in the way, however fast: no step is cut.
TYPED_TEST(Tunneling, IsNotSeenBesideObstaclesNorOnTheWayToAFloor) {
    constexpr int kDim = TypeParam::value;
    for (const Obstacle& obstacle : obstacles_in_the_way<kDim>()) {
        Scene scene = shot<kDim>(obstacle);
        scene.bodies[0].place.translate[1] = 0.5;
        scene.obstacles.push_back(
            {.shape = HalfSpaceObstacle{.normal = Eigen::VectorXd::Unit(kDim, 1), .offset = -9}});
        Simulation<kDim> simulation(scene, {cube<kDim>(1)});
        const StepReport report = simulation.step();
        ASSERT_TRUE(report.is_accepted) << report.failure;
        EXPECT_EQ(report.refused, 0);
        EXPECT_NEAR(mean_velocity(simulation, 0)[0], 60, 0.006);  // tolerance 1e-4 of the solver
    }
}

// Newton's method may get behind a wall around its corner, without a crossing on its way: to where
// a body would be if there were no wall. In a step of two meters that is no motion.
TYPED_TEST(Tunneling, AroundAWallIsSeenWithABarrier) {
    constexpr int kDim = TypeParam::value;
    test::BarrierScene<kDim> scene;
    scene.scene.frames_per_second = 30;
    scene.add(box<kDim>(1, 1, 1, Eigen::VectorXd::Ones(kDim)), test::vector<kDim>(0, 0), 1e7);
    Eigen::VectorXd at = Eigen::VectorXd::Constant(kDim, 0.45);
    at[0] = -1;
    Body& bullet = scene.add(box<kDim>(1, 1, 1, Eigen::VectorXd::Constant(kDim, 0.1)), at, 1e7);
    bullet.velocity = test::vector<kDim>(60, 0);
    bullet.material.density = 8000;
    test::WatchedRun<kDim> run(scene);
    const double before = test::momentum(run.simulation())[0];
    run.run(1);
    EXPECT_EQ(run.failure(), "");
    EXPECT_EQ(run.crossings(), 0);
    const Simulation<kDim>& simulation = run.simulation();
    EXPECT_NEAR(test::momentum(simulation)[0], before, 1e-2 * before);
    EXPECT_GT((simulation.velocities(0) * simulation.masses(0))[0], 0.2 * before);
}

// The same with a wall that is an obstacle, and nothing but one body in the scene.
TYPED_TEST(Tunneling, AroundAnObstacleIsSeenWithABarrier) {
    constexpr int kDim = TypeParam::value;
    test::BarrierScene<kDim> scene;
    scene.scene.frames_per_second = 30;
    Eigen::VectorXd at = Eigen::VectorXd::Constant(kDim, 0.45);
    at[0] = -1;
    scene.add(box<kDim>(1, 1, 1, Eigen::VectorXd::Constant(kDim, 0.1)), at, 1e7).velocity =
        test::vector<kDim>(60, 0);
    scene.scene.obstacles = {{.shape = BoxObstacle{.center = Eigen::VectorXd::Zero(kDim),
                                                   .sides = Eigen::VectorXd::Ones(kDim)}}};
    test::WatchedRun<kDim> run(scene);
    run.run(1);
    EXPECT_EQ(run.failure(), "");
    EXPECT_LT(mean_velocity(run.simulation(), 0)[0], 54);
}

}  // namespace
}  // namespace pent::simulator
