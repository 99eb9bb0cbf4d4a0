#pragma once

#include <pent/contact/box_tree.h>
#include <pent/contact/surface.h>

namespace pent::contact {

/// How many times the surface goes round a point: 1 inside, 0 outside, more where the body overlaps
/// itself, and less where it is inside out. A point on the surface counts with either side.
///
/// Counts, with sign, the facets that a ray along an axis crosses. Which facet a ray crosses at a
/// common face is decided by one rule for all facets of the face (a symbolic shift of the point
/// [edelsbrunner1990]) and by exact signs, so that none is counted twice or missed, neither on
/// lattices nor where corners are in line but for rounding.
///
/// @param facets  Tree over boxes that hold the surface's facets, in their order.
template <int Dim>
[[nodiscard]] int winding_number(const Surface<Dim>& surface,
                                 const BoxTree& facets,
                                 const PositionsView<Dim>& positions,
                                 const Vector<Dim>& point);

}  // namespace pent::contact
