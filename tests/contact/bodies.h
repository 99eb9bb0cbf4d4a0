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

/// A bar of so many cells of 1 m along the first axis, and of one across.
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> bar(int length) {
    std::array<int, Dim> count{};
    std::array<double, Dim> size{};
    count.fill(1);
    size.fill(1);
    count[0] = length;
    size[0] = length;
    return pent::test::kuhn_box<Dim>(count, size);
}

/// A bar bent to part of a spiral: at an amount of 1 its ends lie upon one another, an eighth of a
/// cell apart. By 0 it is as it was.
template <int Dim>
void bend(Positions<Dim>& bar, int length, double amount) {
    if (amount == 0) {
        return;
    }
    const double radius = length / (7.4 * amount);
    for (auto x : bar.colwise()) {
        const double angle = x[0] / radius;
        const double r = radius + 0.1 * angle - x[1];
        x[0] = r * std::sin(angle);
        x[1] = radius - r * std::cos(angle);
    }
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
