#pragma once

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// What holds each vertex: the number of a constraint that has done so from the start, so that all
/// that it holds moves as one rigid body without strain; or one of the values below.
using Grips = std::vector<std::int32_t>;
inline constexpr std::int32_t kNoGrip = -1;     ///< It is free.
inline constexpr std::int32_t kOtherGrip = -2;  ///< Held, but not rigidly with any other.

}  // namespace pent::simulator
