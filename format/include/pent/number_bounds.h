#pragma once

#include <cmath>

namespace pent {

/// Bounds of the size of every number of a scene but 0, in whatever unit: no scene means what is
/// beyond, and volumes and squares of it would leave the range of double.
inline constexpr double kSmallestNumber = 1e-30;
inline constexpr double kLargestNumber = 1e30;

/// Bound of angles, degrees, and of their rates, degrees a second: of larger ones rounding would
/// leave nothing.
inline constexpr double kMaxDegrees = 1e9;

/// Bounds of frames a second, and of what is counted in steps, s: so that counts of steps are whole
/// numbers.
inline constexpr double kMinRate = 1e-6;
inline constexpr double kMaxRate = 1e6;
inline constexpr double kLongestTime = 1e6;

/// Whether a length, a mass, a stiffness ... is above 0 and within bounds.
[[nodiscard]] inline bool is_size(double value) {
    return value >= kSmallestNumber && value <= kLargestNumber;
}

}  // namespace pent
