#pragma once

#include <pent/obstacle.h>
#include <pent/viewer/obstacle_slice.h>
#include <pent/viewer/project.h>
#include <pent/viewer/surface.h>

namespace pent::viewer {

/// How many corners a circle around an obstacle gets.
inline constexpr int kFineCircle = 192;

/// The surface of what an obstacle's slice has solid, turned out of the solid. A ball or a hollow
/// without a plane is closed; a plane is cut off in a circle, and the surface is open there.
///
/// Vertices lie on the surface to rounding. Empty where the slice is empty or everything.
///
/// @param view    What is looked at: a plane ends its radius away from the point of it that is
///                nearest to its center, or further out if it has a hollow there.
/// @param circle  Corners around the whole of a circle, at least 8, even.
[[nodiscard]] TriangleMesh obstacle_surface(const ObstacleSlice& slice,
                                            const Sphere& view,
                                            int circle = kFineCircle);

/// The wall of a slice's ball, hollow or block, as far as it is the obstacle's surface; empty
/// without them.
[[nodiscard]] TriangleMesh wall_surface(const ObstacleSlice& slice, int circle = kFineCircle);

/// The outline of the image of a four-dimensional box, as outline() has it of a body. Empty for a
/// box that is not wholly in front of the eye.
[[nodiscard]] TriangleMesh outline(const Cuboid<4>& box, const Projection& projection);

/// The outline of the image of a four-dimensional ball, as outline() has it of a body: in an
/// orthographic projection a sphere of the ball's radius, in a perspective an ellipsoid. Empty for
/// a ball that is not wholly in front of the eye.
[[nodiscard]] TriangleMesh outline(const Ball<4>& ball,
                                   const Projection& projection,
                                   int circle = kFineCircle);

}  // namespace pent::viewer
