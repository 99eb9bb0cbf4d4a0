#pragma once

#include "ray_scene.h"

#include <pent/viewer/color.h>

#include <Eigen/Core>

#include <array>

namespace pent::viewer {

/// How much of the light arrives at a point: shares of the sky and of the key light, 0..1.
struct Visibility {
    float sky = 1;
    float key = 1;
};

/// The lamps of a picture, set up for a camera; lengths are those of its RaySpace.
struct Lighting {
    Vec up = Vec::UnitY();
    Vec to_key = Vec::UnitY();     ///< Unit, to the middle of the key light.
    Vec to_fill = Vec::UnitX();    ///< Unit, to a weak light from the other side.
    float occlusion_distance = 1;  ///< How far things darken each other under the sky.
    float skin = 1e-4F;            ///< How far off a surface its rays start.
};

/// @param camera_frame  Right, up and back as columns.
[[nodiscard]] Lighting make_lighting(const Eigen::Matrix3d& camera_frame, float scene_size);

/// Rays spent on visibility at one point, and how many sets of them there are, one for
/// each of 8 x 8 pixels.
inline constexpr int kSkyRays = 4;
inline constexpr int kKeyRays = 2;
inline constexpr int kPatterns = 64;

/// The part of light that reaches a point, estimated by a few rays.
///
/// @param normal   Unit, on the side that is seen.
/// @param pattern  0..63: which rays; together all the patterns cover sky and lamp evenly.
[[nodiscard]] Visibility trace_visibility(const RayScene& scene,
                                          const Lighting& lighting,
                                          const Vec& point,
                                          const Vec& normal,
                                          int pattern);

/// What a surface sends to the eye.
///
/// @param albedo  Share of light reflected, linear.
/// @param normal  Unit, smooth, on the side that is seen.
/// @param to_eye  Unit.
[[nodiscard]] Color shade(const Lighting& lighting,
                          const Color& albedo,
                          const Vec& normal,
                          const Vec& to_eye,
                          const Visibility& visibility);

/// How much darker than in the open a floor is, 0..1: 1 in the open.
[[nodiscard]] float floor_light(const Lighting& lighting, const Visibility& visibility);

}  // namespace pent::viewer
