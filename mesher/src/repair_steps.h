#pragma once

#include <pent/mesher/surface.h>

namespace pent::mesher {

/// Drops triangles without area and all but one of equal ones; pairs of opposite ones, which are
/// walls within a body, go both.
[[nodiscard]] Surface drop_useless_triangles(const Surface& surface);

/// Parts a surface into manifold pieces, stitches their borders and fills all holes. What it gives
/// may intersect itself.
[[nodiscard]] Surface close_holes(const Surface& surface);

/// Cuts out self-intersections of a closed surface, as far as that can be done.
/// @param seconds  Limit, checked now and then.
[[nodiscard]] Surface cut_self_intersections(const Surface& surface, double seconds);

/// A closed manifold around a surface: holes up to `alpha` wide are bridged.
/// @param offset  How far outside it lies, m.
[[nodiscard]] Surface wrap(const Surface& surface, double alpha, double offset);

/// Largest distance from samples of one surface to another one, m.
[[nodiscard]] double distance_between(const Surface& from, const Surface& to);

}  // namespace pent::mesher
