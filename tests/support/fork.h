#pragma once

#include "support/kuhn_box.h"

#include <array>
#include <vector>

namespace pent::test {

/// Two arms along x, 1 m thick and 1 m apart, from what joins them at x < 1 m: of two ranks one has
/// the ends of both, and of the ways between them none.
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> fork() {
    std::array<int, Dim> count{};
    count.fill(1);
    count[0] = 6;
    count[1] = 3;
    std::array<double, Dim> size{};
    size.fill(1);
    size[0] = 6;
    size[1] = 3;
    SimplexMesh<Dim> mesh = kuhn_box<Dim>(count, size);
    std::vector<Eigen::Index> kept;
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        Eigen::Matrix<double, Dim, 1> center = Eigen::Matrix<double, Dim, 1>::Zero();
        for (const std::uint32_t vertex : mesh.cells.col(cell)) {
            center += mesh.positions.col(vertex) / (Dim + 1);
        }
        if (center[0] < 1 || center[1] < 1 || center[1] > 2) {
            kept.push_back(cell);
        }
    }
    mesh.cells = mesh.cells(Eigen::all, kept).eval();
    return mesh;
}

}  // namespace pent::test
