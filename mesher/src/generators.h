#pragma once

#include <pent/mesher/tetrahedralize.h>

#include <vector>

namespace pent::mesher {

/// Fills a surface by TetGen in a worker process. Throws an Error if that fails.
[[nodiscard]] Tetrahedra fill_with_tetgen(const Surface& surface, const TetrahedraOptions& options);

/// Fills a surface by CGAL's Mesh_3, body by body. Throws an Error if that fails.
[[nodiscard]] Tetrahedra fill_with_mesh3(const Surface& surface, const TetrahedraOptions& options);

/// The bodies of an oriented surface: each component seen from outside with the cavities in it.
[[nodiscard]] std::vector<Surface> bodies_of(const Surface& surface);

}  // namespace pent::mesher
