#pragma once

#include "overlaps.h"
#include "shared_work.h"

#include <cstdint>
#include <vector>

namespace pent::contact {

/// Simplices of one kind and a tree over boxes that hold them, in their order.
template <int Count>
struct SearchSet {
    const Simplices<Count>& simplices;
    const BoxTree& tree;
};

/// All pairs nearer than `distance` that share no vertex: points and facets, or the mixed pair.
///
/// Exactly what brute force finds, ascending. With one tree on both sides (edges in R^3, within
/// one body) each pair is given once, lower place first. Parallel.
///
/// @param first, second  Their boxes have a margin of at least distance / 2; not checked.
/// @param distance       m, > 0.
/// @param closest        Where closest points have to be for a pair to count.
template <int Dim, int K, int L>
[[nodiscard]] CandidateList near_pairs(const SearchSet<K>& first,
                                       const SearchSet<L>& second,
                                       const PositionsView<Dim>& positions,
                                       double distance,
                                       Closest closest = Closest::Anywhere);

/// Which vertices of one surface are inside another: a 1 for each of surface.vertices that is.
///
/// A group of vertices whose box meets the box of no facet is on one side, and is decided by one
/// ray. Parallel; of a team all have the same trees.
///
/// @param vertices  Tree over boxes that hold the vertices of `surface`, in their order.
/// @param facets    Tree over boxes that hold the facets of `around`, in their order.
template <int Dim>
[[nodiscard]] std::vector<std::uint8_t> vertices_inside(const Surface<Dim>& surface,
                                                        const BoxTree& vertices,
                                                        const Surface<Dim>& around,
                                                        const BoxTree& facets,
                                                        const PositionsView<Dim>& positions,
                                                        const SharedWork& shared = {});

/// Place of the facet nearest to a point; of facets at one distance the first. The surface must
/// have a facet.
template <int Dim>
[[nodiscard]] std::uint32_t nearest_facet(const Surface<Dim>& surface,
                                          const BoxTree& facets,
                                          const PositionsView<Dim>& positions,
                                          const Vector<Dim>& point);

}  // namespace pent::contact
