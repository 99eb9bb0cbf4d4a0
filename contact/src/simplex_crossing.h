#pragma once

#include <pent/contact/stencil.h>

namespace pent::contact {

/// Whether two simplices of K + L = Dim + 2 corners have a point inside both in common: an edge and
/// a facet, and in R^4 two triangles. Two surfaces of dimension Dim - 1 cannot cross without such a
/// pair: the corners of what two crossing facets have in common are of these kinds.
///
/// Dim + 2 points have one affine dependency; the simplices cross if it is positive on one and
/// negative on the other [ziegler1995, Radon]. Its signs are determinants, in long double, and only
/// those that rounding cannot have decided count: where one is in doubt, a face of the pair is
/// within rounding of touching, which is for distances to tell.
template <int Dim, int K, int L>
[[nodiscard]] bool is_crossing(const Corners<Dim, K>& first, const Corners<Dim, L>& second);

}  // namespace pent::contact
