#pragma once

#include <pent/mesher/surface.h>

namespace pent::mesher {

/// Drops triangles without area and all but one of equal ones; pairs of opposite ones, which are
/// walls within a body, go both.
[[nodiscard]] Surface drop_useless_triangles(const Surface& surface);

/// Stitches borders, fills holes and cuts out self-intersections, as far as it can.
/// @param seconds  Limit for the last step, checked now and then.
[[nodiscard]] Surface mend_lightly(const Surface& surface, double seconds);

/// A closed manifold around a surface: holes up to `alpha` wide are bridged.
/// @param offset  How far outside it lies, m.
[[nodiscard]] Surface wrap(const Surface& surface, double alpha, double offset);

/// Largest distance from samples of one surface to another one, m.
[[nodiscard]] double distance_between(const Surface& from, const Surface& to);

}  // namespace pent::mesher
