#pragma once

#include <pent/simplex_mesh.h>

#include <cstdint>
#include <functional>
#include <vector>

namespace pent {

/// How the facets of the cells of a mesh meet. Facet k of a cell is the one without its corner k.
template <int Dim>
struct FacetMatch {
    /// Facets of one cell only, Dim x count, outward: for a positively oriented cell and a vector n
    /// out of the cell, det[n, t1 - t0, ..., t(Dim-1) - t0] > 0. Ordered by cell, then by k.
    Simplices<Dim> boundary;
    std::vector<std::uint32_t> boundary_cells;  ///< The cell behind each boundary facet.
    std::int64_t interior = 0;      ///< Facets shared by two cells that see it from opposite sides.
    std::int64_t one_sided = 0;     ///< Facets shared by two cells that see it from the same side.
    std::int64_t overfull = 0;      ///< Facets shared by more than two cells.
    std::int64_t first_fault = -1;  ///< Lowest cell at a one-sided or overfull facet; -1 if none.

    /// Every facet is shared by two cells from opposite sides, or is on the boundary.
    [[nodiscard]] bool is_conforming() const { return one_sided == 0 && overfull == 0; }
};

/// Finds the boundary and checks that neighbors agree. Facets are hashed in groups that have the
/// same lowest corner: linear time, and 8 bytes a cell beside the boundary itself.
///
/// @param vertices    Number of vertices; indices are below it, not checked.
/// @param is_counted  Whether facets with this lowest corner count; empty if all do. For meshes of
///                    which only some cells are here: those that touch the vertices that count.
template <int Dim>
[[nodiscard]] FacetMatch<Dim> match_facets(
    const Simplices<Dim + 1>& cells,
    Eigen::Index vertices,
    const std::function<bool(std::uint32_t)>& is_counted = {});

}  // namespace pent
