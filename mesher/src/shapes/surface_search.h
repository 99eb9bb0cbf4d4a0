#pragma once

#include <pent/mesher/solid.h>

#include <optional>
#include <span>

namespace pent::mesher {

/// The part of the way from one point to the other where a solid's function is zero, to rounding;
/// its values at the two have different signs.
[[nodiscard]] double zero_between(const Solid& solid, const Sample& from, const Sample& to);

/// The zero that Newton's method reaches along the slope of the function; nothing if it does not
/// get there.
/// @param scale  Of the cells, m: differences are taken over a small part of it.
[[nodiscard]] std::optional<Eigen::Vector4d> nearest_zero(const Solid& solid,
                                                          const Eigen::Vector4d& start,
                                                          double scale);

/// The point near `start` where several pieces are zero at once: each step is the shortest one that
/// solves the linear equations. Nothing if it does not converge, or if they meet nowhere near.
[[nodiscard]] std::optional<Eigen::Vector4d> nearest_common_zero(const Solid& solid,
                                                                 std::span<const int> pieces,
                                                                 const Eigen::Vector4d& start,
                                                                 double scale);

/// Direction in which one piece's function grows.
[[nodiscard]] Eigen::Vector4d piece_normal(const Solid& solid,
                                           int piece,
                                           const Eigen::Vector4d& p,
                                           double scale);

}  // namespace pent::mesher
