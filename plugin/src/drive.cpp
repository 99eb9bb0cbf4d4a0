// What a host does to a simulation.

#include "handles.h"

#include <pent/runs/scene_file.h>

#include <algorithm>
#include <limits>
#include <utility>

using namespace pent;
using namespace pent::plugin;

namespace {

// Vertices of a body, each of which can be in the list once.
std::vector<std::uint32_t> list_of(const uint32_t* vertices, int64_t count, std::int64_t most) {
    if (count < 0 || count > most) {
        throw Error(std::to_string(count) + " vertices were given; the body has "
                    + std::to_string(most));
    }
    if (count > 0) {
        require(vertices, "vertices");
    }
    return {vertices, vertices + count};
}

template <int Dim>
simulator::Grab<Dim> grab_of(const pent_grab& grab) {
    simulator::Grab<Dim> made;
    made.point.body = grab.point.body;
    made.point.cell = grab.point.cell;
    std::copy_n(grab.point.weights, Dim + 1, made.point.weights.data());
    std::copy_n(grab.anchor, Dim, made.anchor.data());
    made.stiffness = grab.stiffness;
    made.damping = grab.damping;
    if (grab.max_force != 0) {
        made.max_force = grab.max_force;
    }
    return made;
}

std::uint64_t grab_number(int64_t grab) {
    return grab < 0 ? 0 : static_cast<std::uint64_t>(grab);
}

// A text with one block alone. What a scene needs besides is put behind it, so that lines are
// counted as the host counts them.
Scene scene_of(const char* text, const char* name, int dimension, const std::string& besides) {
    require(text, "text");
    Scene scene = runs::parse_scene(
        std::string(text) + "\n[scene]\ndimension = " + std::to_string(dimension) + "\n" + besides,
        name, "");
    Scene alone;  // what that block says, and all else as it is by default
    alone.dimension = dimension;
    alone.gravity = scene.gravity;
    alone.bodies = scene.bodies;
    alone.obstacles = scene.obstacles;
    if (scene.bodies.size() != 1 || scene.obstacles.size() != (besides.empty() ? 0U : 1U)
        || runs::scene_text(alone) != runs::scene_text(scene)) {
        throw Error(std::string(name) + ": expected one [[" + name + "]] and nothing else");
    }
    return scene;
}

}  // namespace

int pent_set_targets(pent_simulation* simulation,
                     int body,
                     const uint32_t* vertices,
                     int64_t count,
                     const double* targets) {
    return with_body(simulation, body, -1, [&](auto& held, Opened& /*opened*/) {
        constexpr int kDim = kDimOf<std::remove_reference_t<decltype(held)>>;
        const auto list = list_of(vertices, count, held.mesh(body).vertex_count());
        held.set_targets(body, list, array<kDim>(targets, count, "targets"));
        return 0;
    });
}

int pent_release(pent_simulation* simulation, int body, const uint32_t* vertices, int64_t count) {
    return with_body(simulation, body, -1, [&](auto& held, Opened& /*opened*/) {
        held.release(body, list_of(vertices, count, held.mesh(body).vertex_count()));
        return 0;
    });
}

int64_t pent_add_grab(pent_simulation* simulation, const pent_grab* grab) {
    return with<int64_t>(simulation, -1, [&](auto& held, Opened& /*opened*/) {
        require(grab, "grab");
        constexpr int kDim = kDimOf<std::remove_reference_t<decltype(held)>>;
        return static_cast<int64_t>(held.add_grab(grab_of<kDim>(*grab)));
    });
}

int pent_move_grab(pent_simulation* simulation, int64_t grab, const double* anchor) {
    return with(simulation, -1, [&](auto& held, Opened& /*opened*/) {
        constexpr int kDim = kDimOf<std::remove_reference_t<decltype(held)>>;
        held.move_grab(grab_number(grab), vector<kDim>(anchor, "anchor"));
        return 0;
    });
}

int pent_remove_grab(pent_simulation* simulation, int64_t grab) {
    return with(simulation, -1, [&](auto& held, Opened& /*opened*/) {
        held.remove_grab(grab_number(grab));
        return 0;
    });
}

int pent_set_forces(pent_simulation* simulation, int body, const double* forces) {
    return with_body(simulation, body, -1, [&](auto& held, Opened& /*opened*/) {
        constexpr int kDim = kDimOf<std::remove_reference_t<decltype(held)>>;
        const std::int64_t count = held.mesh(body).vertex_count();
        held.set_forces(body, forces == nullptr
                                  ? Positions<kDim>(Positions<kDim>::Zero(kDim, count))
                                  : array<kDim>(forces, count, "forces"));
        return 0;
    });
}

int pent_set_gravity(pent_simulation* simulation, const double* gravity) {
    return with(simulation, -1, [&](auto& held, Opened& /*opened*/) {
        constexpr int kDim = kDimOf<std::remove_reference_t<decltype(held)>>;
        held.set_gravity(vector<kDim>(gravity, "gravity"));
        return 0;
    });
}

int pent_set_state(pent_simulation* simulation,
                   int body,
                   const double* positions,
                   const double* velocities) {
    return with_body(simulation, body, -1, [&](auto& held, Opened& /*opened*/) {
        constexpr int kDim = kDimOf<std::remove_reference_t<decltype(held)>>;
        const std::int64_t count = held.mesh(body).vertex_count();
        const Positions<kDim> places = array<kDim>(positions, count, "positions");
        held.set_state(body, places, array<kDim>(velocities, count, "velocities"));
        return 0;
    });
}

int pent_add_body(pent_simulation* simulation, const char* text, const pent_mesh* mesh) {
    return with(simulation, -1, [&](auto& held, Opened& opened) {
        constexpr int kDim = kDimOf<std::remove_reference_t<decltype(held)>>;
        require(mesh, "mesh");
        const simulator::Body body = scene_of(text, "body", kDim, "").bodies[0];
        held.add_body(body, mesh_of_body<kDim>(held.scene(), body, *mesh));
        opened.boundaries = std::make_shared<Boundaries>();
        return 0;
    });
}

int pent_remove_body(pent_simulation* simulation, int body) {
    return with_body(simulation, body, -1, [&](auto& held, Opened& opened) {
        held.remove_body(body);
        opened.boundaries = std::make_shared<Boundaries>();
        return 0;
    });
}

int pent_add_obstacle(pent_simulation* simulation, const char* text) {
    return with(simulation, -1, [&](auto& held, Opened& /*opened*/) {
        constexpr int kDim = kDimOf<std::remove_reference_t<decltype(held)>>;
        held.add_obstacle(
            scene_of(text, "obstacle", kDim, "[[body]]\nname = \"any\"\nmesh = \"none\"\n")
                .obstacles[0]);
        return 0;
    });
}

int pent_remove_obstacle(pent_simulation* simulation, int obstacle) {
    return with(simulation, -1, [&](auto& held, Opened& /*opened*/) {
        held.remove_obstacle(obstacle);
        return 0;
    });
}
