#pragma once

#include <pent/simplex_mesh.h>

#include <cmath>
#include <random>
#include <support/kuhn_box.h>

namespace pent::viewer::test {

/// A box of tesseracts with its vertices moved at random by up to a twentieth of a cell, little
/// enough that no cell turns over.
inline SimplexMesh<4> jittered_box(const std::array<int, 4>& count, unsigned seed) {
    SimplexMesh<4> mesh = pent::test::kuhn_box<4>(count, {1.0, 1.5, 0.8, 1.2});
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> step(-0.05, 0.05);
    for (double& coordinate : mesh.positions.reshaped()) {
        coordinate += step(random) * 0.8 / 4;
    }
    return mesh;
}

/// Turns the positions in the xw and yz planes by angles that grow along x.
inline Positions<4> twisted(const Positions<4>& positions, double angle) {
    Positions<4> result = positions;
    for (auto point : result.colwise()) {
        const double a = angle * point.x();
        const double y = point.y() * std::cos(a) - point.z() * std::sin(a);
        const double z = point.y() * std::sin(a) + point.z() * std::cos(a);
        const double x = point.x() * std::cos(a) - point.w() * std::sin(a);
        const double w = point.x() * std::sin(a) + point.w() * std::cos(a);
        point << x, y, z, w;
    }
    return result;
}

}  // namespace pent::viewer::test
