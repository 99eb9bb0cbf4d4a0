#pragma once

#include <pent/simplex_mesh.h>

namespace pent {

/// Sum of the areas of triangles in R^3, m^2.
[[nodiscard]] double triangle_area(const Positions<3>& points, const Simplices<3>& triangles);

/// Volume within a closed surface of triangles that are counterclockwise from outside, m^3; below 0
/// if they are clockwise, 0 if there are none. Measured from the first point, so that nothing
/// cancels far from the origin.
[[nodiscard]] double enclosed_volume(const Positions<3>& points, const Simplices<3>& triangles);

}  // namespace pent
