#pragma once

#include <cstdint>

// Which simplices of two patches may be near each other: a conservative test of all their pairs
// side by side.

namespace pent::contact {

/// Simplices of a patch, at most.
inline constexpr int kLanes = 16;

/// Simplices of a patch, side by side.
struct LanesView {
    const float* corners = nullptr;  ///< [corner][axis][lane], m from the origin; lanes from
                                     ///< `count` on hold the first simplex again.
    const std::int32_t* vertices = nullptr;  ///< [corner][lane]: the same number, the same vertex.
    const double* origin = nullptr;          ///< Dim coordinates, m.
    const float* low = nullptr;   ///< The box around all of them, Dim coordinates, m from the
    const float* high = nullptr;  ///< origin.
    float extent = 0;             ///< The largest absolute value of a coordinate in `corners`.
    int count = 0;
};

/// Two patches on straight paths, each seen from two places that need not be the same. What does
/// not move has the same two views.
struct LanesOnPaths {
    LanesView first_start;
    LanesView first_end;
    LanesView second_start;
    LanesView second_end;
};

/// Sets bit j of near[i], of kLanes entries, to whether simplex i of the first and j of the second
/// patch may be near: all pairs without a common vertex that are nearer than `distance` (m) at some
/// time, and others of which neither their boxes nor a few lines tell that they are not. No pair is
/// lost to rounding of floats. Coordinates are finite; not checked.
///
/// Returns whether there may be any; where not, `near` is of no use.
using FindNearLanes = bool (*)(const LanesOnPaths& patches, double distance, std::uint16_t* near);

}  // namespace pent::contact
