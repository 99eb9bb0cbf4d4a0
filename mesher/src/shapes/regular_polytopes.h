#pragma once

#include <Eigen/Core>

#include <vector>

namespace pent::mesher {

/// Outward unit normals of the cells of the convex regular polytope.
///
/// The 8-cell has its cells across the axes; the others lie as their duals in the usual
/// coordinates.
/// @param cells  5, 8, 16, 24, 120 or 600.
[[nodiscard]] std::vector<Eigen::Vector4d> cell_normals(int cells);

/// Radius of the sphere that touches the cells over that of the one through the vertices.
[[nodiscard]] double inradius_ratio(int cells);

}  // namespace pent::mesher
