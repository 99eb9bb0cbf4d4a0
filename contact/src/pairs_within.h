#pragma once

#include "candidate.h"
#include "overlaps.h"
#include "surface_trees.h"

namespace pent::contact {

/// The pairs of near_pairs() within one body that are at least `rest_distance` apart at rest, and
/// some others, ascending: what belongs to patches that stay_apart() is left out.
template <int Dim, int K, int L>
[[nodiscard]] CandidateList pairs_within(const PatchedSet<Dim, K>& first,
                                         const PatchedSet<Dim, L>& second,
                                         const PositionsView<Dim>& positions,
                                         double distance,
                                         double rest_distance,
                                         Closest closest);

}  // namespace pent::contact
