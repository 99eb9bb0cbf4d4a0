#pragma once

#include <pent/mesher/step_limits.h>
#include <pent/mesher/surface.h>

#include <cstdint>

namespace pent::mesher {

/// Brings a closed surface to a number of triangles, refining or coarsening it.
///
/// Refining bisects the longest edge again and again: the shape does not change, the old points
/// stay first. Coarsening collapses edges at the least cost in shape [lindstrom1998]; where that
/// makes the surface intersect itself, more careful placements are tried. A closed surface has an
/// even number of triangles; an odd target is lowered by one.
///
/// @param surface    Clean (see check_surface) and oriented.
/// @param triangles  4 or more.
/// @param limits     For each way of coarsening.
/// @return           Clean and oriented, with `triangles` triangles when refined, and at most that
///                   many, less a few, when coarsened.
/// Throws an Error if no way was found that keeps the surface clean.
[[nodiscard]] Surface resample(const Surface& surface,
                               std::int64_t triangles,
                               const StepLimits& limits = {});

}  // namespace pent::mesher
