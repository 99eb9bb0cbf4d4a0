#pragma once

#include <pent/facets.h>

#include <cstdint>
#include <vector>

namespace pent::test {

// Meshes that pass validate(), of which cells do not fit together.

/// The mesh with some of its cells once more: their facets within it have three cells.
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> with_cells_twice(SimplexMesh<Dim> mesh,
                                                const std::vector<Eigen::Index>& cells) {
    const Eigen::Index count = mesh.cell_count();
    mesh.cells.conservativeResize(Eigen::NoChange, count + static_cast<Eigen::Index>(cells.size()));
    for (std::size_t i = 0; i < cells.size(); ++i) {
        mesh.cells.col(count + static_cast<Eigen::Index>(i)) = mesh.cells.col(cells[i]);
    }
    return mesh;
}

/// The mesh with one more cell, and one more vertex, at some of the facets of its boundary, on the
/// side where the mesh is: each of these facets has both cells on one side.
///
/// @param facets  In the order of match_facets().
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> with_cells_on_one_side(SimplexMesh<Dim> mesh,
                                                      const std::vector<Eigen::Index>& facets) {
    const FacetMatch<Dim> match = match_facets<Dim>(mesh.cells, mesh.vertex_count());
    for (const Eigen::Index facet : facets) {
        const auto corners = match.boundary.col(facet);
        Eigen::Matrix<double, Dim, 1> center = Eigen::Matrix<double, Dim, 1>::Zero();
        for (const std::uint32_t corner : corners) {
            center += mesh.positions.col(corner) / Dim;
        }
        Eigen::Matrix<std::uint32_t, Dim + 1, 1> cell =
            mesh.cells.col(match.boundary_cells[static_cast<std::size_t>(facet)]);
        for (std::uint32_t& apex : cell) {
            if ((corners.array() != apex).all()) {
                const Eigen::Index vertex = mesh.vertex_count();
                mesh.positions.conservativeResize(Eigen::NoChange, vertex + 1);
                mesh.positions.col(vertex) = 0.8 * mesh.positions.col(apex) + 0.2 * center;
                apex = static_cast<std::uint32_t>(vertex);
            }
        }
        mesh.cells.conservativeResize(Eigen::NoChange, mesh.cell_count() + 1);
        mesh.cells.rightCols(1) = cell;
    }
    return mesh;
}

}  // namespace pent::test
