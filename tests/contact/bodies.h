#pragma once

#include "scenes.h"

#include <cmath>

namespace pent::contact::test {

/// A ball of `count` cells of about 1 m across: the shells of a cube made round. Its surface has
/// small dents.
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> ball(int count) {
    SimplexMesh<Dim> mesh = cube<Dim>(count);
    mesh.positions.array() -= 0.5 * count;
    for (auto x : mesh.positions.colwise()) {
        x *= x.norm() > 0 ? x.template lpNorm<Eigen::Infinity>() / x.norm() : 1;
    }
    return mesh;
}

/// A mesh without those cells for whose middles is_left_out() is true.
template <int Dim, typename IsLeftOut>
[[nodiscard]] SimplexMesh<Dim> carved(SimplexMesh<Dim> mesh, const IsLeftOut& is_left_out) {
    Eigen::Index kept = 0;
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        Vector<Dim> middle = Vector<Dim>::Zero();
        for (const std::uint32_t corner : mesh.cells.col(cell)) {
            middle += mesh.positions.col(corner) / (Dim + 1);
        }
        if (!is_left_out(middle)) {
            mesh.cells.col(kept++) = mesh.cells.col(cell);
        }
    }
    mesh.cells.conservativeResize(Dim + 1, kept);
    return mesh;
}

}  // namespace pent::contact::test
