#pragma once

#include <pent/obstacle.h>
#include <pent/viewer/color.h>
#include <pent/viewer/obstacle_slice.h>
#include <pent/viewer/project.h>
#include <pent/viewer/render.h>
#include <pent/viewer/section.h>

#include <span>
#include <vector>

namespace pent::viewer {

/// The gray of obstacles, in which no body is shown.
[[nodiscard]] Color obstacle_color();

/// The slices of all obstacles, in their order.
template <int Dim>
[[nodiscard]] std::vector<ObstacleSlice> take_sections(std::span<const Obstacle<Dim>> obstacles,
                                                       const Section& section) {
    std::vector<ObstacleSlice> slices;
    for (const Obstacle<Dim>& obstacle : obstacles) {
        slices.push_back(take_section<Dim>(obstacle, section));
    }
    return slices;
}

/// A ball of an obstacle's slice as it is to be seen.
[[nodiscard]] RenderObject ball_object(const Sphere& ball, const Color& color, float opacity);

/// The outline of a four-dimensional ball; without triangles where it has none.
[[nodiscard]] RenderObject outline_object(const Ball<4>& ball,
                                          const Projection& projection,
                                          float opacity);

/// Whether one of them is under what is looked at, as ground or as a hollow around it.
[[nodiscard]] bool has_ground_below(const std::vector<ObstacleSlice>& slices);

}  // namespace pent::viewer
