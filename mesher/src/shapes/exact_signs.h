#pragma once

#include <Eigen/Core>

namespace pent::mesher {

/// Whether a ray from a point along the last axis crosses a tetrahedron of R^4, and how: the sign
/// of the tetrahedron's shadow (its projection on the first three axes), det[b - a, c - a, d - a],
/// if the shadow holds the point's and the tetrahedron is further along the last axis than the
/// point; else 0.
///
/// Exact for the coordinates as they are. Points on the rim of a shadow are decided by symbolic
/// perturbation: as if the point were moved by (e, e^2, e^3) with an infinitely small e, so that it
/// is in exactly one of the shadows that fill a region.
/// @param corners  a b c d, one a column.
[[nodiscard]] int crossing_sign(const Eigen::Matrix4d& corners, const Eigen::Vector4d& point);

}  // namespace pent::mesher
