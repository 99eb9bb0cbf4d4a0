// An engine that hosts the simulator in C++ (host.c is the same in C): a body of four dimensions
// lies on the ground, a pointer at its slice takes hold of it, carries it towards w, and lets it
// go. No file is read.
#include <pent/simulator/picking.h>
#include <pent/simulator/simulation.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <stdexcept>

using namespace pent;
using namespace pent::simulator;

namespace {

Scene make_scene() {
    Scene scene;
    scene.frames_per_second = 60;
    scene.gravity = Eigen::Vector4d(0, -9.8, 0, 0);
    Body jelly;
    jelly.name = "jelly";
    jelly.place.translate = Eigen::Vector4d::Zero();
    jelly.material.lame = lame_from_young(4, 5e4, 0.28);
    jelly.material.density = 100;
    scene.bodies = {jelly};
    const HalfSpaceObstacle ground{.normal = Eigen::Vector4d::UnitY(), .offset = 0};
    scene.obstacles = {{.shape = ground, .stiffness = 200}};
    scene.damping = Damping{.mass = 1, .stiffness = 0.01};
    return scene;
}

// Two pentachora upon one tetrahedron.
SimplexMesh<4> make_mesh() {
    SimplexMesh<4> mesh;
    mesh.positions.setZero(4, 6);
    mesh.positions.row(1).setConstant(0.1);
    mesh.positions(0, 1) = mesh.positions(2, 3) = mesh.positions(3, 4) = 0.5;
    mesh.positions(1, 2) = 0.6;
    mesh.positions(3, 5) = -0.5;
    mesh.cells.resize(5, 2);
    mesh.cells << 0, 1, 1, 0, 2, 2, 3, 3, 4, 5;
    return mesh;
}

void play() {
    Simulation<4> simulation(make_scene(), {make_mesh()}, {.threads = 2});
    std::uint64_t hand = 0;
    double most = 0;  // of w, at vertex 0
    for (int frame = 0; frame < 240; ++frame) {
        if (frame == 60) {  // the button goes down over the body
            const Ray<4> sight{.origin = {0.1, 0.1, -3, 0}, .direction = {0, 0, 1, 0}};
            const auto hit =
                pick(simulation, {.normal = Eigen::Vector4d::UnitW(), .offset = 0.01}, sight);
            hand = simulation.add_grab({.point = hit.value().point,
                                        .anchor = hit->place,
                                        .stiffness = 500,
                                        .damping = 20});
        } else if (frame > 60 && frame <= 120) {  // it is dragged
            const double s = (frame - 60) / 60.0;
            simulation.move_grab(hand, {0.1, 0.1 + 0.5 * s, 0, 0.4 * s});
        } else if (frame == 150) {  // and let go
            simulation.remove_grab(hand);
        }
        const StepReport report = simulation.step();
        if (!report.is_accepted) {
            throw std::runtime_error(report.failure);
        }
        most = std::max(most, simulation.positions(0)(3, 0));  // an engine draws here
    }
    const double lowest = simulation.positions(0).row(1).minCoeff();
    std::printf("carried to w = %.2f, fell back: %s\n", most, lowest < 0.02 ? "yes" : "no");
}

}  // namespace

int main() {
    try {
        play();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
