#pragma once

#include <pent/mesher/surface.h>

namespace pent::mesher {

// Each of these may throw any exception, crash or run away: run it isolated.

/// Drops triangles without area and all but one of equal ones; pairs of opposite ones, which are
/// walls within a body, go both, unless there is nothing else.
[[nodiscard]] Surface drop_useless_triangles(const Surface& surface);

/// Parts a surface into manifold pieces, stitches their borders and fills all holes. What it gives
/// may intersect itself.
[[nodiscard]] Surface close_holes(const Surface& surface);

/// Unites components that cross or touch each other, each taken as a body. The surface comes back
/// as it is if a component crosses itself, or if the union touches itself in points or edges.
/// @param surface  Closed.
[[nodiscard]] Surface unite_crossing_components(const Surface& surface);

/// Cuts out self-intersections of a closed surface, as far as that can be done.
[[nodiscard]] Surface cut_self_intersections(const Surface& surface);

/// A closed manifold around a surface: holes up to `alpha` wide are bridged.
/// @param offset  How far outside it lies, m.
[[nodiscard]] Surface wrap(const Surface& surface, double alpha, double offset);

// This one may not.

/// Largest distance from samples of one surface to another one, m.
[[nodiscard]] double distance_between(const Surface& from, const Surface& to);

}  // namespace pent::mesher
