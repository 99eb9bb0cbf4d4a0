#pragma once

#include <pent/simplex_mesh.h>

#include <cstdint>
#include <vector>

namespace pent::mesher {

/// Whether the boundary of a mesh is a manifold at each of its vertices.
struct LinkReport {
    std::int64_t boundary_vertices = 0;
    std::int64_t faulty = 0;           ///< Vertices whose link is not a sphere.
    std::int64_t first_faulty = -1;    ///< The lowest of them.
    std::int64_t unused_vertices = 0;  ///< Vertices without a cell.
    std::vector<bool> is_faulty;       ///< One a vertex.
};

/// Checks the link of every boundary vertex: what remains of the boundary facets around it if the
/// vertex is taken out of each. The boundary is a manifold exactly if all links are spheres: two
/// points, one circle, or one connected surface of Euler characteristic 2 in dimension 2, 3, 4.
///
/// @param mesh  Conforming with a closed boundary: see prove().
template <int Dim>
[[nodiscard]] LinkReport check_links(const SimplexMesh<Dim>& mesh);

}  // namespace pent::mesher
