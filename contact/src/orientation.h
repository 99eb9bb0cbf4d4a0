#pragma once

#include <Eigen/Core>

namespace pent::contact {

/// Sign of det[p_1 - p_0, ..., p_N - p_0] of N + 1 points in R^N: 1, -1, or 0 where they lie in a
/// hyperplane. Exact: by floating point where rounding cannot change it, else by expansions
/// [shewchuk1997]. So signs fit together: a point is on one side of a simplex to both of its
/// neighbors, and what is inside one of them is not in the other.
///
/// @param points  One a column, finite; products of N differences neither overflow nor underflow.
///                Not checked.
template <int N>
[[nodiscard]] int orientation(const Eigen::Matrix<double, N, N + 1>& points);

}  // namespace pent::contact
