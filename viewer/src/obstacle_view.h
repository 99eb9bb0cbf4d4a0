#pragma once

#include <pent/obstacle.h>
#include <pent/viewer/camera.h>
#include <pent/viewer/color.h>
#include <pent/viewer/obstacle_slice.h>
#include <pent/viewer/project.h>
#include <pent/viewer/render.h>
#include <pent/viewer/section.h>

#include <optional>
#include <span>
#include <vector>

namespace pent::viewer {

/// The gray of obstacles, in which no body is shown.
[[nodiscard]] Color obstacle_color();

/// The slices of all obstacles, in their order.
template <int Dim>
[[nodiscard]] std::vector<ObstacleSlice> take_sections(
    std::span<const ObstacleShape<Dim>> obstacles, const Section& section) {
    std::vector<ObstacleSlice> slices;
    for (const ObstacleShape<Dim>& obstacle : obstacles) {
        slices.push_back(take_section<Dim>(obstacle, section));
    }
    return slices;
}

/// Corners of a circle for views from afar and for measuring: half a percent of the radius.
inline constexpr int kCoarseCircle = 32;

/// How many corners make circles of a ball round in a picture: chords are a tenth of a pixel inside
/// the circle where it is nearest, more only where that would take over kFineCircle. A ball of ten
/// pixels has 576 triangles in place of 36,480 then, and memory goes by what is seen.
///
/// @param height  Of the picture, pixels.
/// @return        A multiple of 8 from 8 to kFineCircle.
[[nodiscard]] int round_circle(const Sphere& ball, const Camera& camera, int height);

/// The ball or the block of an obstacle's slice as it is to be seen.
///
/// @param circle  Corners of a ball's circles.
[[nodiscard]] RenderObject wall_object(const ObstacleSlice& slice,
                                       const Color& color,
                                       float opacity,
                                       int circle);

/// The outline of a four-dimensional obstacle that has an end, round in a picture of the camera and
/// the height in pixels; without triangles where it has none.
[[nodiscard]] RenderObject outline_object(const ObstacleShape<4>& obstacle,
                                          const Projection& projection,
                                          float opacity,
                                          const Camera& camera,
                                          int height);

/// The outline itself; empty for obstacles without an end.
///
/// @param circle  Corners of a ball's circles.
[[nodiscard]] TriangleMesh obstacle_outline(const ObstacleShape<4>& obstacle,
                                            const Projection& projection,
                                            int circle);

/// How far a slice's ball, hollow or block reaches from its middle, m; nothing for a slice without.
[[nodiscard]] std::optional<double> radius_of(const ObstacleSlice& slice);

/// Whether one of them is under what is looked at, as ground or as a hollow around it.
[[nodiscard]] bool has_ground_below(const std::vector<ObstacleSlice>& slices);

}  // namespace pent::viewer
