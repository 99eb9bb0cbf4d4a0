#include "simulator/scenes.h"

#include <pent/simulator/simulation.h>

#include <gtest/gtest.h>

#include <cmath>

// The scene octopus_crawl.toml on a bar.

namespace pent::simulator {
namespace {

// A bar that lies along w on a floor; waves travel along it in a direction, once in `1 / waves` m.
Scene crawler(double waves, double friction) {
    Scene scene = test::box_scene<4>();
    scene.gravity[1] = -9.8;
    scene.frames_per_second = 60;
    scene.bodies[0].material.lame = lame_from_young(4, 2e5, 0.28);
    scene.damping = Damping{.mass = 0, .stiffness = 0.005};
    Activation along;
    along.body = "box";
    along.select = {EverythingSelection{}};
    along.stretch = 0.7;
    along.fibers = Fibers::Constant;
    along.direction = Eigen::Vector4d::Unit(3);
    along.signal = Signal::Sine;
    along.frequency = 2;
    along.wave = waves * Eigen::Vector4d::Unit(3);
    Activation thicker = along;
    thicker.select = {HalfSpaceSelection{Eigen::Vector4d::Unit(1), 0.25}};
    thicker.stretch = 1.4;
    thicker.direction = Eigen::Vector4d::Unit(1);
    thicker.phase = 0.5;
    scene.activations = {along, thicker};
    Obstacle floor;
    floor.shape = HalfSpaceObstacle{Eigen::Vector4d::Unit(1), -0.02};
    floor.distance = 0.02;
    floor.stiffness = 4000;
    scene.obstacles = {floor};
    scene.contact = ContactSettings{.friction = friction, .slip_speed = 0.01};
    scene.solver.tolerance = 1e-6;
    return scene;
}

// How far its center of mass gets along w in two seconds, m.
double way(const Scene& scene) {
    Simulation<4> simulation(scene, {pent::test::kuhn_box<4>({2, 2, 2, 6}, {0.5, 0.5, 0.5, 1.5})},
                             {.threads = 2});
    const auto center = [&] {
        return simulation.positions(0).row(3).dot(simulation.masses(0))
               / simulation.masses(0).sum();
    };
    const double start = center();
    while (simulation.time() < 2) {
        EXPECT_TRUE(simulation.step().is_accepted);
    }
    return center() - start;
}

TEST(Crawler, GoesTheWayOfItsWavesByFrictionAlone) {
    const double there = way(crawler(0.6, 0.8));
    EXPECT_GT(there, 0.25);  // a cell
    // The mirror image, but for the cells, which are cut along diagonals of one direction.
    EXPECT_NEAR(way(crawler(-0.6, 0.8)), -there, 0.2 * there);
    // Inner forces move no center of mass; what is left is what the linear solver leaves.
    EXPECT_LT(std::abs(way(crawler(0.6, 0))), 1e-3 * there);
}

}  // namespace
}  // namespace pent::simulator
