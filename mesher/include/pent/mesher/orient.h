#pragma once

#include <pent/mesher/surface.h>

#include <cstdint>

namespace pent::mesher {

/// A surface oriented to bound a body, and what that took.
struct Oriented {
    Surface surface;
    std::int64_t flipped_triangles = 0;
    std::int64_t components = 0;
    std::int64_t cavities = 0;  ///< Components inside an odd number of others: holes in the body.
};

/// Turns the triangles so that every component bounds the body from outside, and components within
/// others bound cavities (and bodies within cavities again).
///
/// @param surface  Closed and manifold, without self-intersections: see check_surface().
/// Throws an Error for a component that has one side only, or that encloses no volume.
[[nodiscard]] Oriented orient(Surface surface);

}  // namespace pent::mesher
