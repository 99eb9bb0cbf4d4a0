#include "simulator/contact_scenes.h"

#include <pent/simulator/simulation.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

// The scenes octopus_rope.toml, puppet.toml and walker.toml on bars and boxes.

namespace pent::simulator {
namespace {

using test::still;

// A bar of 4 x 1 x 1 x 1 cells of 0.25 m along an axis, centered there.
SimplexMesh<4> bar(int axis) {
    std::array<int, 4> count = {1, 1, 1, 1};
    std::array<double, 4> size = {0.25, 0.25, 0.25, 0.25};
    count[static_cast<std::size_t>(axis)] = 4;
    size[static_cast<std::size_t>(axis)] = 1;
    SimplexMesh<4> mesh = pent::test::kuhn_box<4>(count, size);
    const Eigen::Vector4d middle = mesh.positions.rowwise().mean();
    mesh.positions.colwise() -= middle;
    return mesh;
}

HalfSpaceSelection beyond(int axis, double sign, double at) {
    return {.normal = -sign * Eigen::VectorXd::Unit(4, axis), .offset = -sign * at};
}

Eigen::Vector4d mean_of(const Simulation<4>& simulation, int body) {
    return simulation.positions(body).rowwise().mean();
}

// Three bars tied end to end, the outer ends taken around in yw.
TEST(Rope, OfTiedBodiesSwingsOutOfTheSliceOnBothSidesAndHolds) {
    Scene scene = test::box_scene<4>();
    scene.gravity[1] = -9.8;
    scene.frames_per_second = 60;
    scene.solver.integrator = Integrator::NewtonEuler;
    scene.damping = Damping{.mass = 0.2, .stiffness = 0.002};
    scene.bodies.resize(3, scene.bodies[0]);
    Motion circle = still(4);
    const double rate = 2 * std::numbers::pi / 1.2;
    for (int quarter = 1; quarter <= 6; ++quarter) {
        const double angle = quarter * std::numbers::pi / 2;
        circle.keyframes.push_back(
            {.time = 0.3 * quarter,
             .translate = 0.4 * Eigen::Vector4d(0, 1 - std::cos(angle), 0, std::sin(angle)),
             .rotate = {},
             .velocity = 0.4 * rate * Eigen::Vector4d(0, std::sin(angle), 0, std::cos(angle)),
             .spin = {}});
    }
    for (int i = 0; i < 3; ++i) {
        Body& body = scene.bodies[static_cast<std::size_t>(i)];
        body.name = "bar-" + std::to_string(i);
        body.place.translate = 1.02 * i * Eigen::VectorXd::Unit(4, 0);
        body.material.lame = lame_from_young(4, 1e6, 0.28);
        if (i > 0) {
            Attachment& tie = scene.attachments.emplace_back();
            tie.body = "bar-" + std::to_string(i - 1);
            tie.select = {beyond(0, 1, 1.02 * (i - 1) + 0.49)};
            tie.target = body.name;
            tie.stiffness = 2e4;
            tie.damping = 50;
        }
    }
    scene.constraints = {{.body = "bar-0", .select = {beyond(0, -1, -0.49)}, .motion = {circle}},
                         {.body = "bar-2", .select = {beyond(0, 1, 2.53)}, .motion = {circle}}};
    Simulation<4> simulation(scene, {bar(0), bar(0), bar(0)});
    double least = 0;
    double most = 0;
    while (simulation.time() < 1.8) {
        const StepReport report = simulation.step();
        ASSERT_TRUE(report.is_accepted) << report.failure;
        EXPECT_EQ(report.inverted, 0);
        for (const AttachmentSummary& tie : report.attachments) {
            EXPECT_EQ(tie.springs, 8);
            EXPECT_LT(tie.largest_force / 2e4, 0.05);  // m
        }
        const double w = mean_of(simulation, 1)[3];
        least = std::min(least, w);
        most = std::max(most, w);
    }
    EXPECT_LT(least, -0.25);  // the thickness along w: nothing of it is in the slice
    EXPECT_GT(most, 0.25);
}

// In equilibrium springs to points carry the weight, wherever the points are; after their motion
// the body hangs in the same way somewhere else.
TEST(Puppet, HangsFromPointsThatMoveAsItDidBefore) {
    Scene scene = test::box_scene<4>();
    scene.gravity[1] = -9.8;
    scene.solver.integrator = Integrator::NewtonEuler;
    scene.damping = Damping{.mass = 5, .stiffness = 0};
    Motion motion = still(4);
    const Eigen::Vector4d there(0, 0.3, 0, 0.4);
    motion.keyframes = {
        {.time = 3, .translate = there / 3, .rotate = {}, .velocity = {}, .spin = {}},
        {.time = 4, .translate = there, .rotate = {}, .velocity = {}, .spin = {}}};
    motion.from = 2;
    for (const double sign : {-1.0, 1.0}) {
        Attachment& spring = scene.attachments.emplace_back();
        spring.body = "box";
        spring.select = {beyond(0, sign, sign * 0.49)};
        spring.motion = {motion};
        spring.stiffness = 500;
    }
    Simulation<4> simulation(scene, {bar(0)});
    const double weight = simulation.masses(0).sum() * 9.8;
    const auto hang_until = [&](double time) {
        StepReport report;
        while (simulation.time() < time - 1e-9) {
            report = simulation.step();
            EXPECT_TRUE(report.is_accepted) << report.failure;
        }
        EXPECT_NEAR(report.attachments[0].force + report.attachments[1].force, weight,
                    2e-3 * weight);
        return simulation.positions(0);
    };
    const Positions<4> before = hang_until(2);
    const Positions<4> after = hang_until(7);
    EXPECT_LT((after - (before.colwise() + there)).cwiseAbs().maxCoeff(), 2e-3);
}

// Long along w, on a ball that turns in xw: friction turns it along x, and without it nothing does.
TEST(Walker, IsTurnedByABallUnderItThroughFrictionAlone) {
    const auto turned_to_x = [](double friction) {
        Scene scene = test::box_scene<4>();
        scene.gravity[1] = -9.8;
        scene.frames_per_second = 60;
        scene.solver.integrator = Integrator::NewtonEuler;
        Eigen::VectorXd center = Eigen::VectorXd::Zero(4);
        center[1] = -4.13;
        Motion turn = still(4);
        turn.rotate = {{{0, 3}, 60}};
        scene.obstacles = {{.shape = BallObstacle{.center = center, .radius = 4},
                            .distance = 0.04,
                            .stiffness = 5e4,
                            .motion = {turn},
                            .friction = friction}};
        scene.contact = ContactSettings{.distance = 0.04, .friction = friction};
        Simulation<4> simulation(scene, {bar(3)});
        while (simulation.time() < 1) {
            const StepReport report = simulation.step();
            EXPECT_TRUE(report.is_accepted) << report.failure;
        }
        const Positions<4> x = simulation.positions(0).colwise() - mean_of(simulation, 0);
        const Eigen::Vector4d along = x * simulation.mesh(0).positions.row(3).transpose();
        return std::abs(along[0]) / along.norm();
    };
    // The ball turns by 60 degrees. It touches the bar near the middle alone, where friction has a
    // short arm, so that the bar lags behind.
    const double with_friction = turned_to_x(0.8);
    EXPECT_GT(with_friction, std::sin(std::numbers::pi / 9));
    EXPECT_LT(with_friction, std::sin(std::numbers::pi / 3));
    EXPECT_LT(turned_to_x(0), 1e-2 * with_friction);
}

}  // namespace
}  // namespace pent::simulator
