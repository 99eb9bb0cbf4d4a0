#pragma once

#include <Eigen/Core>

namespace pent::mesher {

/// Where a point lies as seen along the last axis from a tetrahedron of R^4: the sign of the
/// tetrahedron's shadow on the first three axes, det[b - a, c - a, d - a], if the shadow holds the
/// point's and the tetrahedron is further along the last axis than the point; else 0.
///
/// Exact for the coordinates as they are. Shadows on the rim of a face are decided as if the point
/// were moved by (e, e^2, e^3) with an infinitely small e, so that a point is in exactly one of the
/// shadows that fill a region.
/// @param corners  a b c d, one a column.
[[nodiscard]] int crossing_sign(const Eigen::Matrix4d& corners, const Eigen::Vector4d& point);

}  // namespace pent::mesher
