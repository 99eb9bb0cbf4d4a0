#pragma once

#include <pent/contact/stencil.h>

#include <algorithm>
#include <cmath>

namespace pent::contact {

/// Whether the boxes of two sets of points are at least a distance apart: then so are their hulls,
/// which is a cheap way to rule most pairs out.
template <int Dim, int M, int N>
[[nodiscard]] bool are_boxes_apart(const Corners<Dim, M>& first,
                                   const Corners<Dim, N>& second,
                                   double distance_squared) {
    const Vector<Dim> above = second.rowwise().minCoeff() - first.rowwise().maxCoeff();
    const Vector<Dim> below = first.rowwise().minCoeff() - second.rowwise().maxCoeff();
    return above.cwiseMax(below).cwiseMax(0).squaredNorm() >= distance_squared;
}

/// The same for points that move linearly, each from its column in one matrix to that in the other:
/// whether the boxes are that far apart at all times. Their gap along an axis is concave in time,
/// so that both ends tell.
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

/// The gap between two sets of points along a line, from the first to the second, times the length
/// of `line`.
template <int Dim, int M, int N>
[[nodiscard]] double gap_along(const Vector<Dim>& line,
                               const Corners<Dim, M>& first,
                               const Corners<Dim, N>& second) {
    return (line.transpose() * second).minCoeff() - (line.transpose() * first).maxCoeff();
}

/// Whether two sets of points are farther than a distance apart along the line through their
/// middles. Never where these are the same point.
template <int Dim, int M, int N>
[[nodiscard]] bool are_apart_along_middles(const Corners<Dim, M>& first,
                                           const Corners<Dim, N>& second,
                                           double distance) {
    const Vector<Dim> line = second.rowwise().mean() - first.rowwise().mean();
    return gap_along<Dim, M, N>(line, first, second) > distance * line.norm();
}

/// How much nearer the hulls of two sets of points that move linearly can come on their way, at
/// most: the longest path of a point of one relative to a point of the other.
template <int Dim, int M, int N>
[[nodiscard]] double relative_path_length(const Corners<Dim, M>& first,
                                          const Corners<Dim, M>& first_end,
                                          const Corners<Dim, N>& second,
                                          const Corners<Dim, N>& second_end) {
    const Corners<Dim, M> a = first_end - first;
    const Corners<Dim, N> b = second_end - second;
    double squared = 0;
    for (int i = 0; i < M; ++i) {
        squared = std::max(squared, (b.colwise() - a.col(i)).colwise().squaredNorm().maxCoeff());
    }
    return std::sqrt(squared);
}

}  // namespace pent::contact
