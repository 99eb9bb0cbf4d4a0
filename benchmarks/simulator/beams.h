#pragma once

#include "support/kuhn_box.h"

#include <pent/simulator/scene.h>

namespace pent::simulator::bench {

/// A box of cubes of 0.1 m, layers along w of `thickness` m, columns labeled.
inline SimplexMesh<4> box(const std::array<int, 4>& count, double thickness = 0.1) {
    SimplexMesh<4> mesh = pent::test::kuhn_box<4>(
        count, {0.1 * count[0], 0.1 * count[1], 0.1 * count[2], thickness * count[3]});
    const auto base = static_cast<std::uint32_t>((count[0] + 1) * (count[1] + 1) * (count[2] + 1));
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        mesh.columns.push_back(v % base);
        mesh.layers.push_back(v / base);
    }
    return mesh;
}

/// 259,200 pentachora, 17,493 vertices.
inline SimplexMesh<4> beam(double thickness = 0.1) {
    return box({50, 6, 6, 6}, thickness);
}

/// Density 1000, E = 1e7, held at x = 0, gravity along -y, 30 steps a second.
inline Scene beam_scene(double poisson = 0.28) {
    Scene scene;
    scene.gravity = Eigen::Vector4d(0, -9.8, 0, 0);
    Body body;
    body.name = "beam";
    body.mesh = "beam.pent";
    body.place.translate = Eigen::Vector4d::Zero();
    body.material.lame = lame_from_young(4, 1e7, poisson);
    scene.bodies = {body};
    Motion still;
    still.translate = Eigen::Vector4d::Zero();
    const HalfSpaceSelection end{.normal = Eigen::Vector4d(1, 0, 0, 0), .offset = 1e-6};
    scene.constraints = {{.body = "beam", .select = {end}, .motion = {still}}};
    scene.solver.tolerance = 1e-3;
    return scene;
}

}  // namespace pent::simulator::bench
