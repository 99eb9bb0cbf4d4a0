#pragma once

#include <pent/contact/stencil.h>
#include <pent/simd.h>

#include <Eigen/Core>

#include <algorithm>
#include <limits>

namespace pent::contact {

/// An axis-aligned box in R^3 or R^4, in float; closed. In R^3 the fourth interval is [0, 0].
struct alignas(16) Box {
    float low[4];   // NOLINT(modernize-avoid-c-arrays): loaded as one vector
    float high[4];  // NOLINT(modernize-avoid-c-arrays)
};

/// Whether two boxes have a point in common. Never true for a box with a NaN.
[[nodiscard, gnu::always_inline]] inline bool overlap(const Box& a, const Box& b) {
    using Four = Pack<float, 4>;
    return all(Four::load_aligned(a.low) <= Four::load_aligned(b.high)
               && Four::load_aligned(b.low) <= Four::load_aligned(a.high));
}

/// An empty box: it overlaps nothing, and its hull with another box is the other.
inline constexpr Box kNowhere = [] {
    constexpr float kFar = std::numeric_limits<float>::infinity();
    return Box{{kFar, kFar, kFar, kFar}, {-kFar, -kFar, -kFar, -kFar}};
}();

/// The smallest box around both.
[[nodiscard]] Box hull(const Box& a, const Box& b);

/// A box that holds the points, one a column, and everything within `margin` of them, in exact
/// arithmetic: rounded outward. Coordinates are below 1e37 m in size, not checked.
template <int Dim, int Count>
[[nodiscard]] Box box_around(const Eigen::Matrix<double, Dim, Count>& points, double margin);

/// Squared distance of a point to a box, m^2; 0 inside.
template <int Dim>
[[nodiscard]] double distance_squared(const Vector<Dim>& point, const Box& box) {
    double sum = 0;
    for (int axis = 0; axis < Dim; ++axis) {
        const double below = static_cast<double>(box.low[axis]) - point[axis];
        const double above = point[axis] - static_cast<double>(box.high[axis]);
        const double outside = std::max(std::max(below, above), 0.0);
        sum += outside * outside;
    }
    return sum;
}

}  // namespace pent::contact
