#pragma once

#include <pent/contact/surface.h>

#include <Eigen/Core>

// Whether bodies cross, by trying every pair of simplices: no trees, no closest points and no
// advancement of the library. All in long double.

namespace pent::test {

using Real = long double;

template <int Dim, int Count>
using RealCorners = Eigen::Matrix<Real, Dim, Count>;

/// Whether K + L = Dim + 2 corners are two simplices with a common point: the one point where their
/// hulls meet, by its barycentric coordinates.
template <int Dim, int K, int L>
[[nodiscard]] bool do_cross(const RealCorners<Dim, K>& a, const RealCorners<Dim, L>& b);

/// Whether K + L = Dim + 1 corners are two simplices that meet while each corner goes straight from
/// its place in a0 or b0 to that in a1 or b1: at a root in [0, 1] of the volume that they span, a
/// polynomial of degree Dim in t, at which their distance is 0.
template <int Dim, int K, int L>
[[nodiscard]] bool do_meet(const RealCorners<Dim, K>& a0,
                           const RealCorners<Dim, K>& a1,
                           const RealCorners<Dim, L>& b0,
                           const RealCorners<Dim, L>& b1);

/// Pairs of simplices of two surfaces (or one and itself) that go through each other.
template <int Dim>
[[nodiscard]] int count_crossings(const contact::Surface<Dim>& first,
                                  const contact::Surface<Dim>& second,
                                  const Positions<Dim>& positions);

/// Pairs of two surfaces (or one and itself) that meet while all vertices go straight from one
/// place to another.
template <int Dim>
[[nodiscard]] int count_swept_crossings(const contact::Surface<Dim>& first,
                                        const contact::Surface<Dim>& second,
                                        const Positions<Dim>& from,
                                        const Positions<Dim>& to);

}  // namespace pent::test
