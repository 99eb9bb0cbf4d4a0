#pragma once

#include <pent/contact/closest_points.h>

namespace pent::contact {

/// Whether the boxes of two sets of points are at least a distance apart: a cheap no to whether the
/// points' hulls are nearer.
template <int Dim, int M, int N>
[[nodiscard]] bool are_boxes_apart(const Corners<Dim, M>& first,
                                   const Corners<Dim, N>& second,
                                   double distance_squared) {
    const Vector<Dim> above = second.rowwise().minCoeff() - first.rowwise().maxCoeff();
    const Vector<Dim> below = first.rowwise().minCoeff() - second.rowwise().maxCoeff();
    return above.cwiseMax(below).cwiseMax(0).squaredNorm() >= distance_squared;
}

}  // namespace pent::contact
