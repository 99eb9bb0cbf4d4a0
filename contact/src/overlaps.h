#pragma once

#include "candidate.h"
#include "chunks.h"
#include "closest_point_search.h"
#include "gather.h"

#include <pent/contact/box_tree.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

// The walk through pairs of boxes that overlap, which all searches have in common.

namespace pent::contact {

/// Pieces of work of a search: enough for any number of threads, few enough to cost nothing, and
/// none that is not worth a thread.
inline constexpr std::size_t kPieces = 512;
inline constexpr std::size_t kBoxesInPiece = 64;

/// Calls visit(i, j, found) for all boxes i and j of two trees that overlap, or of one tree with
/// itself: each pair of different boxes once. Each piece of work finds into a list of its own;
/// their order depends on the trees alone. Pairs of boxes are not stored. Parallel.
template <typename Found, typename Visit>
[[nodiscard]] std::vector<Found> walk_overlaps(const BoxTree& first,
                                               const BoxTree& second,
                                               const Visit& visit) {
    const std::size_t pieces =
        std::clamp<std::size_t>((first.size() + second.size()) / kBoxesInPiece, 1, kPieces);
    const std::vector<BoxTree::Work> work = BoxTree::split(first, second, pieces);
    std::vector<Found> found(work.size());
    parallel_for(work.size(), [&](std::size_t piece) {
        Found& here = found[piece];
        BoxTree::for_each_overlap(first, second, work[piece],
                                  [&](std::uint32_t i, std::uint32_t j) { visit(i, j, here); });
    });
    return found;
}

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

/// Which pairs a search is for.
enum class Closest : std::uint8_t {
    Anywhere,  ///< All.
    Interior,  ///< Those whose closest points are inside both simplices; several times faster.
};

/// Adds pairs of two lists of simplices that share no vertex and are nearer than a limit. Within
/// one list (edges in R^3, within one body) a pair has the lower place first.
template <int Dim, int K, int L>
struct NearTest {
    using Found = CandidateList;

    const Simplices<K>& first;
    const Simplices<L>& second;
    bool is_same_list = false;
    const PositionsView<Dim>& positions;
    double limit_squared = 0;  ///< m^2.
    Closest closest = Closest::Anywhere;

    void operator()(std::uint32_t i, std::uint32_t j, CandidateList& found) const {
        ++found.overlaps;
        if (share_a_vertex<K, L>(first, i, second, j)) {
            return;
        }
        if (is_same_list && j < i) {
            std::swap(i, j);
        }
        const Corners<Dim, K> a = gather<Dim, K>(first, i, positions);
        const Corners<Dim, L> b = gather<Dim, L>(second, j, positions);
        ClosestPointSearch<Dim, K, L> search(a, b, limit_squared);
        if (closest == Closest::Interior ? search.run_interior() : search.run()) {
            found.pairs.push_back({i, j, rounded_down(std::sqrt(search.best().distance_squared))});
        }
    }
};

/// The pairs that all pieces of work found, as one list of known distances.
[[nodiscard]] inline CandidateList joined(const std::vector<CandidateList>& pieces) {
    CandidateList all;
    std::size_t count = 0;
    for (const CandidateList& piece : pieces) {
        count += piece.pairs.size();
        all.overlaps += piece.overlaps;
    }
    all.pairs.reserve(count);
    for (const CandidateList& piece : pieces) {
        all.pairs.insert(all.pairs.end(), piece.pairs.begin(), piece.pairs.end());
    }
    all.known_count = count;
    return all;
}

/// The same, ascending.
[[nodiscard]] inline CandidateList sorted(CandidateList list) {
    std::sort(list.pairs.begin(), list.pairs.end(), is_before);
    return list;
}

}  // namespace pent::contact
