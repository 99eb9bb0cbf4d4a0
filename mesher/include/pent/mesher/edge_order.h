#pragma once

#include <pent/extrusion.h>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace pent::mesher {

/// Directed edges of a mesh, one a column, from row 0 to row 1.
///
/// A direction says how the rectangle above an edge is cut when the mesh is extruded: by the
/// diagonal from the bottom of the first vertex to the top of the second [shi2025, Sec. 3].
using DirectedEdges = Simplices<2>;

/// Where the directions come from when the user gives none: each edge goes to the later vertex.
enum class VertexOrder {
    Index,    ///< As the vertices are numbered.
    Sweep,    ///< Along the longest side of the bounding box.
    Quality,  ///< Improved from Index so that the worst simplices of a slab are better.
};

/// Every edge of the mesh once, from the lower to the higher index, sorted.
template <int Dim>
[[nodiscard]] DirectedEdges edges_of(const Simplices<Dim + 1>& cells);

/// Every edge of the mesh once, directed from the vertex of lower rank to that of higher rank.
///
/// @param ranks  One a vertex, all different.
template <int Dim>
[[nodiscard]] DirectedEdges direct_edges(const SimplexMesh<Dim>& mesh,
                                         const std::vector<std::uint32_t>& ranks);

/// Ranks of the vertices by number, or along the longest side; Quality starts from Index, see
/// improve_ranks().
template <int Dim>
[[nodiscard]] std::vector<std::uint32_t> rank_vertices(const SimplexMesh<Dim>& mesh,
                                                       VertexOrder order);

/// Moves vertices in the order so that the worst simplices around them become better.
///
/// Vertices are taken in turn, those around the worst simplices first, and each gets the rank among
/// its neighbors' that is best for the prisms around it. The worst mean ratio of a slab never
/// falls. Takes some 10 us a vertex and sweep.
/// @param ranks   One a vertex, all different.
/// @param slab    From a base vertex to its copy, m.
/// @param sweeps  At most.
template <int Dim>
[[nodiscard]] std::vector<std::uint32_t> improve_ranks(
    const SimplexMesh<Dim>& mesh,
    std::vector<std::uint32_t> ranks,
    const Eigen::Matrix<double, Dim + 1, 1>& slab,
    int sweeps = 4);

/// Orders the corners of every cell by the directions of the edges.
///
/// If all edges together have no cycle, the order is that of a topological sort of their graph.
/// Otherwise each cell is ordered on its own, which works if no triangle is a cycle: exactly then
/// every prism over a cell can be cut into simplices without added points.
/// Throws an Error if an edge of the mesh has no direction or two, if a directed edge is not one of
/// the mesh, or if triangles are cycles; it lists the first few.
template <int Dim>
[[nodiscard]] OrderedCells<Dim> order_cells(const SimplexMesh<Dim>& mesh,
                                            const DirectedEdges& edges);

/// Reads directed edges: two 0-based vertices a line, `#` for comments. Throws an Error that names
/// the line for what cannot be read or is not below `vertices`.
[[nodiscard]] DirectedEdges read_directed_edges(const std::filesystem::path& path,
                                                std::int64_t vertices);

}  // namespace pent::mesher
