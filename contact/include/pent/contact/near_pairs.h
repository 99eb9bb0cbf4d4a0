#pragma once

#include <pent/contact/surface.h>

#include <cstdint>
#include <vector>

namespace pent::contact {

/// Two simplices, by their places in two lists, and their squared distance, m^2.
struct NearPair {
    std::uint32_t first = 0;
    std::uint32_t second = 0;
    double distance_squared = 0;
};

/// Simplices of one kind and a tree over boxes that hold them, in their order.
template <int Count>
struct SearchSet {
    const Simplices<Count>& simplices;
    const BoxTree& tree;
};

/// Which pairs a query is for.
enum class Closest : std::uint8_t {
    Anywhere,  ///< All.
    Interior,  ///< Those whose closest points are inside both simplices; several times faster.
};

struct NearPairs {
    std::vector<NearPair> pairs;  ///< Ascending by first, then second.
    std::int64_t candidates = 0;  ///< Pairs whose boxes overlap: the work of the narrow phase.
};

/// All pairs nearer than `distance` that share no vertex: points and facets, or the mixed pair.
///
/// Exactly what brute force finds, in an order that depends neither on the trees nor on the number
/// of threads. Pairs of boxes are not stored. With one list on both sides (edges in R^3, within
/// one body) each pair is given once, lower place first. Parallel.
///
/// @param first, second  Their boxes have a margin of at least distance / 2; not checked.
/// @param distance       m, > 0.
/// @param closest        Where closest points have to be for a pair to count.
template <int Dim, int K, int L>
[[nodiscard]] NearPairs near_pairs(const SearchSet<K>& first,
                                   const SearchSet<L>& second,
                                   const PositionsView<Dim>& positions,
                                   double distance,
                                   Closest closest = Closest::Anywhere);

/// Of pairs found before, those that are nearer than `distance` now: what near_pairs() finds now, if
/// no other pair can have come nearer. Parallel.
template <int Dim, int K, int L>
[[nodiscard]] NearPairs still_near_pairs(const NearPairs& before,
                                         const Simplices<K>& first,
                                         const Simplices<L>& second,
                                         const PositionsView<Dim>& positions,
                                         double distance,
                                         Closest closest = Closest::Anywhere);

/// Which vertices of one surface are inside another: an entry of 1 for each of surface.vertices.
///
/// A group of vertices whose box meets no facet is on one side, and is decided by one ray. Parallel.
///
/// @param vertices  Tree over boxes that hold the vertices of `surface`, in their order.
/// @param facets    Tree over boxes that hold the facets of `around`, in their order.
template <int Dim>
[[nodiscard]] std::vector<std::uint8_t> vertices_inside(const Surface<Dim>& surface,
                                                        const BoxTree& vertices,
                                                        const Surface<Dim>& around,
                                                        const BoxTree& facets,
                                                        const PositionsView<Dim>& positions);

/// The facet nearest to a point, and its squared distance; `second` is the facet, `first` 0. Of
/// facets at one distance the first. The surface must have a facet.
template <int Dim>
[[nodiscard]] NearPair nearest_facet(const Surface<Dim>& surface,
                                     const BoxTree& facets,
                                     const PositionsView<Dim>& positions,
                                     const Vector<Dim>& point);

}  // namespace pent::contact
