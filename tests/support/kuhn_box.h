#pragma once

#include <pent/simplex_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace pent::test {

/// A box of cubes, each cut into Dim! simplices along the paths from its lowest to its highest
/// corner (Kuhn). Vertex i of the grid is numbered with the first axis fastest.
///
/// @param count  Cubes along each axis.
/// @param size   Edge of the box along each axis, m.
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> kuhn_box(const std::array<int, Dim>& count,
                                        const std::array<double, Dim>& size) {
    std::array<int, Dim + 1> stride{};
    stride[0] = 1;
    int cubes = 1;
    for (int axis = 0; axis < Dim; ++axis) {
        stride[axis + 1] = stride[axis] * (count[axis] + 1);
        cubes *= count[axis];
    }
    SimplexMesh<Dim> mesh;
    mesh.positions.resize(Dim, stride[Dim]);
    for (int vertex = 0; vertex < stride[Dim]; ++vertex) {
        for (int axis = 0; axis < Dim; ++axis) {
            const int step = vertex / stride[axis] % (count[axis] + 1);
            mesh.positions(axis, vertex) = size[axis] * step / count[axis];
        }
    }
    std::array<int, Dim> order{};
    std::iota(order.begin(), order.end(), 0);
    int paths = 1;
    for (int k = 2; k <= Dim; ++k) {
        paths *= k;
    }
    mesh.cells.resize(Dim + 1, cubes * paths);
    int cell = 0;
    for (int cube = 0; cube < cubes; ++cube) {
        int corner = 0;
        int rest = cube;
        for (int axis = 0; axis < Dim; ++axis) {
            corner += rest % count[axis] * stride[axis];
            rest /= count[axis];
        }
        std::sort(order.begin(), order.end());
        do {
            int at = corner;
            mesh.cells(0, cell) = at;
            for (int k = 0; k < Dim; ++k) {
                at += stride[order[k]];
                mesh.cells(k + 1, cell) = at;
            }
            if (cell_volume<Dim>(mesh.positions, mesh.cells, cell) < 0) {
                std::swap(mesh.cells(Dim - 1, cell), mesh.cells(Dim, cell));
            }
            ++cell;
        } while (std::next_permutation(order.begin(), order.end()));
    }
    return mesh;
}

/// The same with every edge cut in two, which is the box of twice as many cubes, and its cells
/// labeled by the one of the coarser box that they lie in.
///
/// @param count  Cubes of the coarser box along each axis.
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> quadratic_kuhn_box(const std::array<int, Dim>& count,
                                                  const std::array<double, Dim>& size) {
    std::array<int, Dim> twice{};
    for (int axis = 0; axis < Dim; ++axis) {
        twice[axis] = 2 * count[axis];
    }
    SimplexMesh<Dim> mesh = kuhn_box<Dim>(twice, size);
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        Eigen::Matrix<double, Dim, 1> center = Eigen::Matrix<double, Dim, 1>::Zero();
        for (int a = 0; a <= Dim; ++a) {
            center += mesh.positions.col(mesh.cells(a, cell)) / (Dim + 1);
        }
        // The cube, and the order of the coordinates in it: a cell has one of its own.
        std::array<double, Dim> within{};
        std::uint32_t label = 0;
        for (int axis = 0; axis < Dim; ++axis) {
            const double at = center[axis] / size[axis] * count[axis];
            within[axis] = at - std::floor(at);
            label = label * count[axis] + static_cast<std::uint32_t>(at);
        }
        for (int i = 0; i < Dim; ++i) {
            for (int j = 0; j < i; ++j) {
                label = 2 * label + (within[i] > within[j] ? 1 : 0);
            }
        }
        mesh.parents.push_back(label);
    }
    return mesh;
}

}  // namespace pent::test
