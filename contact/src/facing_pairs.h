#pragma once

#include "patches.h"

#include <pent/contact/near_pairs.h>

namespace pent::contact {

/// Least |n2 - n1| of the unit outward normals at two points of a body that can be in contact: a line
/// between points that meets both surfaces at a sine above kLeastView sees each of them from the front,
/// or each from the back, only where the normals differ by twice that.
inline constexpr double kLeastView = 0.2;

/// Boxes that hold the outward normals everywhere on simplices, those within a simplex being the
/// normalized means of those at its corners.
///
/// @param normals  Dim x vertices of the scene: unit vectors, or zero.
template <int Dim, int Count>
[[nodiscard]] std::vector<Box> normal_boxes(const Simplices<Count>& simplices,
                                            const Positions<Dim>& normals);

/// Simplices of one body, a tree over boxes that hold them, their normal_boxes(), the same tree over
/// these, and how its patches have moved from rest: none if that is not to be looked at.
template <int Dim, int Count>
struct FacingSet {
    const Simplices<Count>& simplices;
    const BoxTree& tree;
    const std::vector<Box>& normal_boxes;
    const BoxTree& normals;
    const std::vector<PatchMotion<Dim>>& motions;
};

/// The pairs of near_pairs() within one body, less
///
/// - those whose normals differ by less than 2 kLeastView all over;
/// - some of those that are `rest_distance` apart at rest, or nearer than that at rest.
///
/// The first are nearly all of a smooth surface, the second nearly all of a body that has not been
/// bent much; both are left out in large pieces.
template <int Dim, int K, int L>
[[nodiscard]] NearPairs facing_pairs(const FacingSet<Dim, K>& first,
                                     const FacingSet<Dim, L>& second,
                                     const PositionsView<Dim>& positions,
                                     double distance,
                                     double rest_distance,
                                     Closest closest);

}  // namespace pent::contact
