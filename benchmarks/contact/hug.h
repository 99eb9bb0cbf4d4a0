#pragma once

#include "support/kuhn_box.h"

#include <pent/contact/surface.h>

#include <array>
#include <random>

namespace pent::contact::bench {

/// Two boxes of 4D cells of 0.1 m side by side, in one array of positions; vertices are shaken by a
/// tenth of a cell, since aligned boxes are not what bodies look like.
struct Hug {
    Positions<4> positions;
    std::array<Surface<4>, 2> surfaces;
    std::array<std::uint32_t, 3> first_vertex{};
};

/// With 60 x 12 x 3 x 2 cells and a gap of `gap` m: 96,768 boundary tetrahedra in all, 193,536
/// triangles, 112,992 edges, the size of the armadillo scene of [shi2025] Table 1.
///
/// @param scale  Multiplies the first axis: 1 for the sizes above.
inline Hug make_hug(double gap, double scale = 1) {
    constexpr double kCell = 0.1;
    const int length = static_cast<int>(60 * scale);
    const SimplexMesh<4> box =
        pent::test::kuhn_box<4>({length, 12, 3, 2}, {length * kCell, 1.2, 0.3, 0.2});
    const Eigen::Index n = box.vertex_count();
    Hug hug;
    hug.positions.resize(4, 2 * n);
    hug.positions << box.positions, box.positions;
    hug.positions.rightCols(n).row(3).array() += 0.2 + gap;
    hug.positions.rightCols(n).row(0).array() += 0.3 * kCell;  // not vertex upon vertex
    std::mt19937 random(1);
    std::uniform_real_distribution<double> shake(-0.05 * kCell, 0.05 * kCell);
    for (Eigen::Index i = 0; i < hug.positions.size(); ++i) {
        hug.positions.data()[i] += shake(random);
    }
    for (std::uint32_t body = 0; body < 2; ++body) {
        hug.first_vertex[body] = body * static_cast<std::uint32_t>(n);
        hug.surfaces[body] = make_surface<4>(box.cells, n, hug.first_vertex[body]);
    }
    return hug;
}

}  // namespace pent::contact::bench
