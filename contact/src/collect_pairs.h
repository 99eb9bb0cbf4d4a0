#pragma once

#include "closest_point_search.h"
#include "gather.h"

#include <pent/contact/near_pairs.h>

#include <algorithm>
#include <utility>

// What queries for near pairs have in common.

namespace pent::contact {

/// Pieces of work of a query: enough for any number of threads, few enough to cost nothing.
inline constexpr std::size_t kPieces = 512;

template <int K, int L>
[[nodiscard]] bool share_a_vertex(const Simplices<K>& first,
                                  Eigen::Index i,
                                  const Simplices<L>& second,
                                  Eigen::Index j) {
    bool is_shared = false;
    for (int a = 0; a < K; ++a) {
        for (int b = 0; b < L; ++b) {
            is_shared |= first(a, i) == second(b, j);
        }
    }
    return is_shared;
}

/// Adds a pair if it is nearer than the limit.
template <int Dim, int K, int L>
void add_if_near(const Simplices<K>& first,
                 std::uint32_t i,
                 const Simplices<L>& second,
                 std::uint32_t j,
                 const PositionsView<Dim>& positions,
                 double limit_squared,
                 Closest closest,
                 NearPairs& pairs) {
    const Corners<Dim, K> a = gather<Dim, K>(first, i, positions);
    const Corners<Dim, L> b = gather<Dim, L>(second, j, positions);
    ClosestPointSearch<Dim, K, L> search(a, b, limit_squared);
    if (closest == Closest::Interior ? search.run_interior() : search.run()) {
        pairs.pairs.push_back({i, j, search.best().distance_squared});
    }
}

/// Counts a pair of simplices whose boxes overlap, and adds it if it is nearer than the limit and no
/// vertex is in both.
///
/// @param is_same_list  The simplices are those of one list: a pair then has the lower one first.
template <int Dim, int K, int L>
void visit_candidate(const Simplices<K>& first,
                     std::uint32_t i,
                     const Simplices<L>& second,
                     std::uint32_t j,
                     bool is_same_list,
                     const PositionsView<Dim>& positions,
                     double limit_squared,
                     Closest closest,
                     NearPairs& pairs) {
    ++pairs.candidates;
    if (share_a_vertex<K, L>(first, i, second, j)) {
        return;
    }
    if (is_same_list && j < i) {
        std::swap(i, j);
    }
    add_if_near<Dim, K, L>(first, i, second, j, positions, limit_squared, closest, pairs);
}

/// Collects what the pieces of work found, in one order.
[[nodiscard]] inline NearPairs merge(const std::vector<NearPairs>& pieces) {
    NearPairs all;
    std::size_t count = 0;
    for (const NearPairs& piece : pieces) {
        count += piece.pairs.size();
        all.candidates += piece.candidates;
    }
    all.pairs.reserve(count);
    for (const NearPairs& piece : pieces) {
        all.pairs.insert(all.pairs.end(), piece.pairs.begin(), piece.pairs.end());
    }
    std::sort(all.pairs.begin(), all.pairs.end(), [](const NearPair& a, const NearPair& b) {
        return a.first != b.first ? a.first < b.first : a.second < b.second;
    });
    return all;
}

}  // namespace pent::contact
