#pragma once

#include "support/kuhn_box.h"

#include <pent/simulator/scene.h>

#include <array>
#include <random>

namespace pent::simulator::bench {

inline constexpr double kEps = 0.025;  // a quarter of a cell

// A box of cubes of 0.1 m, columns labeled.
inline SimplexMesh<4> box(const std::array<int, 4>& count) {
    SimplexMesh<4> mesh = pent::test::kuhn_box<4>(
        count, {0.1 * count[0], 0.1 * count[1], 0.1 * count[2], 0.1 * count[3]});
    const auto base = static_cast<std::uint32_t>((count[0] + 1) * (count[1] + 1) * (count[2] + 1));
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        mesh.columns.push_back(v % base);
        mesh.layers.push_back(v / base);
    }
    return mesh;
}

// A body of density 1000 with E = 1e7, nu = 0.28; the linear solver goes to 1e-3.
inline Scene one_body() {
    Scene scene;
    scene.gravity = Eigen::Vector4d::Zero();
    Body body;
    body.name = "body";
    body.mesh = "body.pent";
    body.place.translate = Eigen::Vector4d::Zero();
    body.material.lame = lame_from_young(4, 1e7, 0.28);
    scene.bodies = {body};
    scene.contact = ContactSettings{.distance = kEps, .stiffness = 1e4};
    scene.solver.tolerance = 1e-3;
    return scene;
}

// Two bodies of 60 x 12 x 3 x 2 cells, 207,360 pentachora in all, face to face along w, between two
// plates that leave them a little less room than they have at rest. Contact is so soft that the
// faces stay at about half of its distance.
inline Scene hug_scene(bool self) {
    constexpr double kThick = 0.2;
    constexpr double kSqueeze = 0.01;  // at either plate, m
    Scene scene = one_body();
    scene.frames_per_second = 200;
    scene.bodies.push_back(scene.bodies[0]);
    scene.bodies[1].name = "other";
    scene.bodies[1].place.translate = Eigen::Vector4d(0.03, 0, 0, kThick + 0.5 * kEps);
    const HalfSpaceObstacle below{.normal = Eigen::Vector4d::UnitW(), .offset = kSqueeze};
    const HalfSpaceObstacle above{.normal = -Eigen::Vector4d::UnitW(),
                                  .offset = kSqueeze - 2 * kThick - 0.5 * kEps};
    scene.obstacles = {{.shape = below, .distance = 1e-3, .stiffness = 1e5},
                       {.shape = above, .distance = 1e-3, .stiffness = 1e5}};
    scene.contact->stiffness = 1e3;
    scene.contact->self = self;
    return scene;
}

// Shaken by a tenth of a cell: aligned boxes are not what bodies look like. Two cells thick along
// w, as hug_scene() expects.
inline SimplexMesh<4> hug_body(unsigned seed, const std::array<int, 4>& cells = {60, 12, 3, 2}) {
    SimplexMesh<4> mesh = box(cells);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> shake(-0.005, 0.005);
    for (double& x : mesh.positions.reshaped()) {
        x += shake(random);
    }
    return mesh;
}

}  // namespace pent::simulator::bench
