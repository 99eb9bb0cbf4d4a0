#pragma once

#include <pent/simplex_mesh.h>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// Which vertices have unknowns, and in which order.
///
/// Vertices of one extrusion column come one after the other, from layer to layer; columns (single
/// vertices, where a mesh knows no columns) in reverse Cuthill-McKee order, which keeps neighbors
/// close in memory [cuthill1969].
struct Numbering {
    std::vector<std::uint32_t> unknown_of_vertex;  ///< Held vertices: free_count + vertex.
    std::vector<std::uint32_t> vertex_of_unknown;  ///< free_count entries.
    std::vector<std::uint32_t> column_start;  ///< Unknowns of column c: [start[c], start[c + 1]).

    [[nodiscard]] std::uint32_t free_count() const {
        return static_cast<std::uint32_t>(vertex_of_unknown.size());
    }
    [[nodiscard]] bool is_free(std::uint32_t vertex) const {
        return unknown_of_vertex[vertex] < free_count();
    }
};

/// @param cells    Of all bodies, vertices counted through.
/// @param is_held  One entry a vertex.
/// @param columns  One entry a vertex: vertices with the same number form a column; no gaps.
/// @param layers   One entry a vertex: its place within the column.
template <int Dim>
[[nodiscard]] Numbering number_unknowns(const Simplices<Dim + 1>& cells,
                                        const std::vector<bool>& is_held,
                                        const std::vector<std::uint32_t>& columns,
                                        const std::vector<std::uint32_t>& layers);

}  // namespace pent::simulator
