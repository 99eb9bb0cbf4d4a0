#pragma once

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// What holds each vertex: the place of a constraint that has done so from the start, so that what
/// it holds moves as a rigid body and is strained by nothing; or one of these.
using Grips = std::vector<std::int32_t>;
inline constexpr std::int32_t kNoGrip = -1;     ///< It is free.
inline constexpr std::int32_t kOtherGrip = -2;  ///< Held, but not rigidly with any other.

}  // namespace pent::simulator
