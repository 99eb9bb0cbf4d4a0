#pragma once

#include <cmath>

namespace pent::simulator {

/// Which times are the same: steps begin and end at sums of rounded times, and what is to happen at
/// one of them is to happen there and not a step later.

/// Times that differ by no more than this part of a step are the same: far more than rounding, and
/// no step.
inline constexpr double kSameTime = 1e-6;

/// The least number of steps dt that reach a time; >= 0 for times that are.
[[nodiscard]] inline double steps_to(double time, double dt) {
    return std::ceil(time / dt - kSameTime);
}

/// The number of whole steps dt up to a time.
[[nodiscard]] inline double whole_steps(double time, double dt) {
    return std::floor(time / dt + kSameTime);
}

/// Whether a step is over, of which a part in [0, 1] has gone by.
[[nodiscard]] inline bool is_whole_step(double part) {
    return part >= 1 - kSameTime;
}

/// Whether one time is the other or before it.
[[nodiscard]] inline bool is_by(double time, double other, double dt) {
    return time <= other + kSameTime * dt;
}

}  // namespace pent::simulator
