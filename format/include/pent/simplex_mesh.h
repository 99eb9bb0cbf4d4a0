#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <string_view>
#include <vector>

namespace pent {

/// One point a column: Dim x n, meters, axes in the order x y z w.
template <int Dim>
using Positions = Eigen::Matrix<double, Dim, Eigen::Dynamic>;

/// One simplex a column: Corners x n indices of vertices, 0-based.
template <int Corners>
using Simplices = Eigen::Matrix<std::uint32_t, Corners, Eigen::Dynamic>;

/// A mesh of Dim-simplices in R^Dim: triangles, tetrahedra or pentachora (Dim 2, 3, 4).
///
/// Every cell is positively oriented: det[v1 - v0, ..., vDim - v0] > 0.
template <int Dim>
struct SimplexMesh {
    Positions<Dim> positions;            ///< Dim x vertices, m.
    Simplices<Dim + 1> cells;            ///< (Dim + 1) x cells.
    std::vector<std::uint16_t> regions;  ///< One a cell, a label free to use; or empty.
    std::vector<std::uint32_t> columns;  ///< One a vertex, or empty: which vertex of the base mesh
                                         ///< it was extruded from.
    std::vector<std::uint32_t> layers;   ///< One a vertex, or empty: in which layer.
    std::vector<std::uint32_t> parents;  ///< One a cell, or empty: which quadratic cell it is a
                                         ///< child of, one of 2^Dim; see docs/pent-format.md.
    Positions<Dim> fibers;  ///< Dim x cells, or no columns: a direction in each, of any length
                            ///< above 0, or zero where there is none.

    [[nodiscard]] Eigen::Index vertex_count() const { return positions.cols(); }
    [[nodiscard]] Eigen::Index cell_count() const { return cells.cols(); }
};

/// What a cell is called in dimension 2, 3 or 4: "triangle", "tetrahedron" or "pentachoron".
[[nodiscard]] std::string_view cell_name(int dim);

/// The same in the plural: "triangles", "tetrahedra" or "pentachora".
[[nodiscard]] std::string_view cell_name_plural(int dim);

/// Signed volume (area in the plane) of one simplex: det[p1 - p0, ..., pDim - p0] / Dim!, in m^Dim.
///
/// @param corners  One corner a column.
template <int Dim>
[[nodiscard]] double simplex_volume(const Eigen::Matrix<double, Dim, Dim + 1>& corners);

/// Signed measure of cell `cell` with the vertices at `positions`, in m^Dim.
template <int Dim>
[[nodiscard]] double cell_volume(const Positions<Dim>& positions,
                                 const Simplices<Dim + 1>& cells,
                                 Eigen::Index cell);

/// Sum of the signed measures of all cells, in m^Dim, added in the order of the cells.
template <int Dim>
[[nodiscard]] double total_volume(const SimplexMesh<Dim>& mesh);

/// Throws an Error unless the mesh is one that may be written and simulated.
///
/// Checked: at least one cell; coordinates finite; every index in range; no vertex twice in a cell;
/// every cell positively oriented and not degenerate, which is det[v1 - v0, ...] > 1e-14 times the
/// product of the lengths of these edges, so that rounding cannot have decided the sign; optional
/// arrays of the right length. Not checked: whether neighbors agree (see match_facets).
///
/// @param name  Goes in front of the message, usually the file's path.
template <int Dim>
void validate(const SimplexMesh<Dim>& mesh, std::string_view name);

}  // namespace pent
