#pragma once

#include <pent/simulator/scene.h>

#include <vector>

namespace pent::simulator {

/// The factor at a time, s: a cubic between each two keyframes, constant before the first and
/// behind the last; 1 without any.
///
/// Its slope is continuous, zero at both ends and at every keyframe that is no lower or no higher
/// than both its neighbors, so that it never leaves the range of the two keyframes around it
/// [fritsch1984].
[[nodiscard]] double factor_at(const std::vector<Keyframe>& keyframes, double time);

}  // namespace pent::simulator
