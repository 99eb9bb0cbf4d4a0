#pragma once

#include "patches.h"

#include <pent/contact/near_pairs.h>

namespace pent::contact {

/// Simplices of one body, a tree over boxes that hold them, in their order, and how the patches of
/// this tree have moved from rest.
template <int Dim, int Count>
struct PatchedSet {
    const Simplices<Count>& simplices;
    const BoxTree& tree;
    const std::vector<PatchMotion<Dim>>& motions;
};

/// The pairs of near_pairs() within one body that are at least `rest_distance` apart at rest, and some
/// others: what belongs to patches that stay_apart() is left out.
template <int Dim, int K, int L>
[[nodiscard]] NearPairs pairs_within(const PatchedSet<Dim, K>& first,
                                     const PatchedSet<Dim, L>& second,
                                     const PositionsView<Dim>& positions,
                                     double distance,
                                     double rest_distance,
                                     Closest closest);

}  // namespace pent::contact
