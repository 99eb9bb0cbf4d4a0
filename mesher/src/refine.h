#pragma once

#include <pent/mesher/surface.h>

namespace pent::mesher {

/// Bisects the longest edge of a closed manifold surface until it has `triangles` triangles or one
/// more. Equal lengths are taken in the order of their points.
[[nodiscard]] Surface refine(const Surface& surface, Eigen::Index triangles);

}  // namespace pent::mesher
