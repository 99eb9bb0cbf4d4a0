#pragma once

#include <pent/simulator/scene.h>

#include <cstddef>
#include <optional>
#include <vector>

namespace pent::simulator {

/// A point that a curve goes through.
struct CurvePoint {
    double time = 0;  ///< s.
    double value = 0;
    std::optional<double> slope = {};  ///< 1/s; absent: chosen so that the curve is smooth.
};

/// A curve at a time.
struct CurveState {
    double value = 0;
    double slope = 0;  ///< 1/s.
};

/// Whether a time is behind another one by more than the rounding of a sum of steps.
[[nodiscard]] inline bool is_behind(double time, double other) {
    return time > other * (1 + 1e-12);
}

/// A cubic Hermite curve through at least one point, constant before the first and behind the last.
///
/// Slopes that are not given are zero at both ends and at local extrema, so that between two of
/// these the curve is monotone and never leaves the range of their values [fritsch1984]. At the
/// last point the curve has the slope of that.
///
/// @param point  point(i) is the i-th of `count` CurvePoints; their times ascend.
template <typename Point>
[[nodiscard]] CurveState curve_at(std::size_t count, const Point& point, double time);

/// The factor at a time, s, by such a curve; 1 without any keyframe.
[[nodiscard]] double factor_at(const std::vector<Keyframe>& keyframes, double time);

namespace detail {

/// The slope of a smooth curve at the middle one of three points: the weighted harmonic mean of the
/// rises on both sides, [fritsch1984] Eq. 5.
[[nodiscard]] double smooth_slope(const CurvePoint& before,
                                  const CurvePoint& here,
                                  const CurvePoint& behind);

/// The cubic between two points with these slopes.
[[nodiscard]] CurveState cubic_at(
    const CurvePoint& a, const CurvePoint& b, double slope_a, double slope_b, double time);

}  // namespace detail

template <typename Point>
CurveState curve_at(std::size_t count, const Point& point, double time) {
    std::size_t next = 0;  // the first that is later
    for (std::size_t end = count; next < end;) {
        const std::size_t middle = (next + end) / 2;
        if (point(middle).time > time) {
            end = middle;
        } else {
            next = middle + 1;
        }
    }
    const auto slope = [&](std::size_t i) {
        const CurvePoint here = point(i);
        const bool is_end = i == 0 || i + 1 == count;
        return here.slope ? *here.slope
               : is_end   ? 0
                          : detail::smooth_slope(point(i - 1), here, point(i + 1));
    };
    if (next == 0) {
        return {point(0).value, 0};
    }
    const CurvePoint before = point(next - 1);
    if (next == count) {
        return {before.value, is_behind(time, before.time) ? 0 : slope(next - 1)};
    }
    return detail::cubic_at(before, point(next), slope(next - 1), slope(next), time);
}

}  // namespace pent::simulator
