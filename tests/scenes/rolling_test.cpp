#include "simulator/scenes.h"

#include <pent/simulator/simulation.h>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

// The scene duocylinders.toml on boxes that are bent to duocylinders.

namespace pent::simulator {
namespace {

constexpr double kRadius = 0.5;
constexpr double kSpeed = 1.2;

// A square times a square, each of them taken to a disk.
SimplexMesh<4> duocylinder() {
    SimplexMesh<4> mesh = pent::test::kuhn_box<4>({6, 6, 6, 6}, {2, 2, 2, 2});
    for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
        for (const int first : {0, 2}) {
            const double a = mesh.positions(first, v) - 1;
            const double b = mesh.positions(first + 1, v) - 1;
            mesh.positions(first, v) = kRadius * a * std::sqrt(1 - b * b / 2);
            mesh.positions(first + 1, v) = kRadius * b * std::sqrt(1 - a * a / 2);
        }
    }
    return mesh;
}

// One that lies on the ground, on its round side in the plane of y and `along`, and moves there.
Scene pushed(int along) {
    Scene scene = test::box_scene<4>();
    scene.gravity[1] = -9.8;
    scene.frames_per_second = 60;
    scene.solver.integrator = Integrator::Bdf2;
    Body& body = scene.bodies[0];
    body.material.lame = lame_from_young(4, 1e6, 0.28);
    body.place.translate = Eigen::Vector4d(0, kRadius + 0.02, 0, 0);
    if (along == 3) {
        body.place.rotate = {{{1, 2}, 90}};  // y to z: its plane zw becomes that of y and w
    }
    body.velocity = kSpeed * Eigen::Vector4d::Unit(along);
    HalfSpaceObstacle ground;
    ground.normal = Eigen::Vector4d::UnitY();
    ground.offset = 0;
    scene.obstacles = {{.shape = ground, .distance = 0.04, .stiffness = 5e4}};
    scene.contact = ContactSettings{.distance = 0.04, .friction = 0.5, .slip_speed = 0.01};
    return scene;
}

Eigen::Vector4d mean_velocity(const Simulation<4>& simulation) {
    const Eigen::VectorXd& masses = simulation.masses(0);
    return simulation.velocities(0) * masses / masses.sum();
}

// Friction takes from what slides until it rolls. About the line of contact no torque acts, so that
// m v0 r = m v r + I v / r, and with I = m r^2 / 2 of a disk v = 2/3 v0, whatever the friction is.
TEST(Duocylinder, ThatIsPushedRollsOnWithTwoThirdsOfItsSpeedOnEitherOfItsSides) {
    for (const int along : {0, 3}) {
        Simulation<4> simulation(pushed(along), {duocylinder()});
        for (int step = 0; step < 15; ++step) {  // it slides for v0 / (3 mu g) = 0.08 s
            ASSERT_TRUE(simulation.step().is_accepted);
        }
        double mean = 0;
        for (int step = 0; step < 15; ++step) {
            ASSERT_TRUE(simulation.step().is_accepted);
            const Eigen::Vector4d velocity = mean_velocity(simulation);
            mean += velocity[along] / 15;
            EXPECT_LT(std::abs(velocity[along == 0 ? 3 : 0]), 0.05 * kSpeed);
            EXPECT_LT(std::abs(velocity[2]), 0.05 * kSpeed);
        }
        // A prism of 24 sides loses a bit of it at each of its edges, and gains nothing.
        EXPECT_LT(mean, 1.01 * 2 / 3 * kSpeed) << along;
        EXPECT_GT(mean, 0.93 * 2 / 3 * kSpeed) << along;
    }
}

}  // namespace
}  // namespace pent::simulator
