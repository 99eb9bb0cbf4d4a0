#pragma once

#include "support/kuhn_box.h"

#include <pent/simulator/scene.h>

namespace pent::simulator::test {

/// A scene of one body called "box" without gravity, 30 frames a second.
template <int Dim>
Scene box_scene() {
    Scene scene;
    scene.dimension = Dim;
    scene.gravity = Eigen::VectorXd::Zero(Dim);
    Body body;
    body.name = "box";
    body.mesh = "box.pent";
    body.place.translate = Eigen::VectorXd::Zero(Dim);
    body.material.lame = lame_from_young(Dim, 1e5, 0.28);
    scene.bodies = {body};
    return scene;
}

inline Constraint hold(const Selection& selection, const Motion& motion) {
    return {.body = "box", .select = {selection}, .motion = {motion}};
}

/// No motion at all.
inline Motion still(int dim) {
    Motion motion;
    motion.translate = Eigen::VectorXd::Zero(dim);
    return motion;
}

/// What is at x = 0, in four dimensions.
inline HalfSpaceSelection left_end() {
    return {.normal = Eigen::Vector4d(1, 0, 0, 0), .offset = 1e-6};
}

/// Of a bar() that is turned by its left end, falls and is damped.
inline Scene swinging_bar() {
    Scene scene = box_scene<4>();
    scene.gravity[1] = -9.8;
    Motion motion = still(4);
    motion.rotate = {{{3, 0}, 60}};
    scene.constraints = {hold(left_end(), motion)};
    scene.damping = Damping{.mass = 0.1, .stiffness = 0.002};
    return scene;
}

/// A bar along x with labeled columns and layers along w.
inline SimplexMesh<4> bar(int length = 6) {
    SimplexMesh<4> mesh =
        pent::test::kuhn_box<4>({length, 2, 2, 2}, {0.25 * length, 0.5, 0.5, 0.5});
    const auto base = static_cast<std::uint32_t>((length + 1) * 9);
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        mesh.columns.push_back(v % base);
        mesh.layers.push_back(v / base);
    }
    return mesh;
}

}  // namespace pent::simulator::test
