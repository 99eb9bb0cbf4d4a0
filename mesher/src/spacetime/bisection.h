#pragma once

#include <pent/mesher/moving_mesh.h>
#include <pent/simplex_mesh.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace pent::mesher {

/// Facets at which the condition for bisection of [stevenson2008] does not hold: that two
/// cells of type 0 are reflected neighbors if one's refinement edge, from its first to its last
/// corner, is in their common facet, and else their children at it are.
///
/// @param cells  Conforming, corners in the order of bisection.
[[nodiscard]] std::int64_t bisection_faults(const Simplices<5>& cells);

/// Colors 0 to 3 of the vertices so that each tetrahedron has all four; nothing if there are none.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> color_vertices(const SimplexMesh<3>& mesh);

/// Cuts every tetrahedron into the 24 of its barycenters and those of its faces and edges. Vertices
/// come first, then middles of edges, of faces and of tetrahedra: four colors in the order of their
/// indices. Points move with the barycenters, fields of vertices are means, those of cells, regions
/// and labels of triangles are handed down.
[[nodiscard]] MovingMesh barycentric_cut(const MovingMesh& moving);

}  // namespace pent::mesher
