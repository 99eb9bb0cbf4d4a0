#pragma once

#include <pent/number_bounds.h>

#include <limits>
#include <string>

namespace pent {

/// Which numbers a key takes, beside 0 or a size within bounds.
struct Range {
    double low = -std::numeric_limits<double>::infinity();
    bool low_included = true;
    double high = std::numeric_limits<double>::infinity();
    bool high_included = true;
    double smallest = kSmallestNumber;  ///< Of the size, but for 0.
    double largest = kLargestNumber;
};

inline constexpr Range kAnyNumber{};
inline constexpr Range kPositive{.low = 0, .low_included = false};
inline constexpr Range kNotNegative{.low = 0};
inline constexpr Range kAngle{.low = -kMaxDegrees, .high = kMaxDegrees};
inline constexpr Range kFraction{
    .low = 0, .low_included = false, .high = 1, .high_included = false};

/// Finite and between the ends.
[[nodiscard]] bool is_between(const Range& range, double value);

/// 0, or of a size within the bounds.
[[nodiscard]] bool is_of_size(const Range& range, double value);

/// "" if the range has the number, else what completes "expected ...": "a
/// number above 0", or "0 or a size from 1e-30 to 1e+30", without the 0 if that is not in it.
[[nodiscard]] std::string expected_in(const Range& range, double value);

/// "a number above 0 and below 1".
[[nodiscard]] std::string text_of(const Range& range);

/// A number as messages show it.
[[nodiscard]] std::string readable(double value);

}  // namespace pent
