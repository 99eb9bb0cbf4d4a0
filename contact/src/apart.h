#pragma once

#include <pent/contact/stencil.h>

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

/// The same for points that move evenly, each from its column in one matrix to that in the other:
/// whether the boxes are that far apart at all times. How far they are along an axis is concave in
/// time.
template <int Dim, int M, int N>
[[nodiscard]] bool are_paths_apart(const Corners<Dim, M>& first,
                                   const Corners<Dim, M>& first_end,
                                   const Corners<Dim, N>& second,
                                   const Corners<Dim, N>& second_end,
                                   double distance_squared) {
    const Vector<Dim> above =
        (second.rowwise().minCoeff() - first.rowwise().maxCoeff())
            .cwiseMin(second_end.rowwise().minCoeff() - first_end.rowwise().maxCoeff());
    const Vector<Dim> below =
        (first.rowwise().minCoeff() - second.rowwise().maxCoeff())
            .cwiseMin(first_end.rowwise().minCoeff() - second_end.rowwise().maxCoeff());
    return above.cwiseMax(below).cwiseMax(0).squaredNorm() >= distance_squared;
}

}  // namespace pent::contact
