#pragma once

#include "patch_bound.h"

#include <cstdint>

// How near patches may have come to each other, from how each has moved: for several pairs side by
// side.

namespace pent::contact {

/// Rows of numbers, one for each patch: how it has moved (PatchMotion). Axes beyond those of space
/// are 0.
struct MotionRows {
    static constexpr int kAxes = 4;
    static constexpr int kEarlierCenter = 0;                  ///< What a row begins with.
    static constexpr int kSizes = kEarlierCenter + kAxes;     ///< Least stretch, radius, deviation.
    static constexpr int kPlaces = kSizes + kAxes;            ///< One behind the other.
    static constexpr int kPlaceSize = kAxes + kAxes * kAxes;  ///< Where a map takes the origin, and
                                                              ///< the columns of the map.

    const double* numbers = nullptr;
    int places = 1;  ///< The end, and the start of paths that are not still.

    [[nodiscard]] static constexpr int size(int places) { return kPlaces + places * kPlaceSize; }
};

/// Sets bounds[i] to that of a patch and of patch which[i] of others.
///
/// @param first  Its row, of as many places.
using BoundMotions = void (*)(const double* first,
                              const MotionRows& others,
                              const std::uint32_t* which,
                              int count,
                              PatchBound* bounds);

}  // namespace pent::contact
