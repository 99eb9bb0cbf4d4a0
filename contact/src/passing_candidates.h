#pragma once

#include "candidates.h"

#include <pent/parallel.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pent::contact {

/// Where a candidate is from: its list, by its place among all lists of all meetings, and the
/// colliders that its two simplices belong to.
struct ListPlace {
    std::uint32_t list = 0;
    int first = 0;
    int second = 0;
};

/// The candidates that may come within a distance on the way between two positions, in chunks of
/// all lists: small bodies have short ones, which would not be worth several threads each.
template <int Dim>
class PassingCandidates {
public:
    /// Parallel.
    ///
    /// @param candidates  That cover the way; must outlive this.
    /// @param distance    Between simplices, m; less the radii of their colliders.
    PassingCandidates(const Candidates<Dim>& candidates,
                      const PositionsView<Dim>& from,
                      const PositionsView<Dim>& to,
                      double distance);
    // It refers to parts of its own.
    PassingCandidates(const PassingCandidates&) = delete;
    PassingCandidates& operator=(const PassingCandidates&) = delete;

    /// How many are tested one by one; the rest of a list may be culled as a whole.
    [[nodiscard]] std::int64_t count() const { return count_; }

    /// Calls look.operator()<K, L>(place, pair, part) for each that passes. Chunks are looked at in
    /// parallel, each with a part of its own, which begins as a Part(). Returns these in the order
    /// of chunks.
    template <typename Part, typename Look>
    [[nodiscard]] std::vector<Part> look_at_each(const Look& look) const {
        std::vector<Part> parts(chunks_.size());
        parallel_for(chunks_.size(), [&](std::size_t c) {
            const std::uint32_t list = chunks_[c].list;
            visit_list<Dim>(pairs_of(list), list % kLists, [&]<int K, int L>(const ListOfTwo& of) {
                look_at_chunk<K, L>(chunks_[c], of, look, parts[c]);
            });
        });
        return parts;
    }

private:
    struct Chunk {
        std::uint32_t list = 0;
        std::size_t begin = 0;  // in the list
        std::size_t end = 0;
    };

    [[nodiscard]] const CandidatePairs& pairs_of(std::uint32_t list) const {
        return candidates_.meetings()[list / kLists].pairs;
    }

    template <int K, int L, typename Look, typename Part>
    void look_at_chunk(const Chunk& chunk,
                       const ListOfTwo& of,
                       const Look& look,
                       Part& part) const {
        const Surface<Dim>& first = candidates_.colliders().surface(of.first);
        const Surface<Dim>& second = candidates_.colliders().surface(of.second);
        const ListPlace place{chunk.list, of.first, of.second};
        for (std::size_t k = chunk.begin; k < chunk.end; ++k) {
            if (culls_[chunk.list].passes(k, first.template simplices<K>(),
                                          second.template simplices<L>())) {
                look.template operator()<K, L>(place, of.list.pairs[k], part);
            }
        }
    }

    const Candidates<Dim>& candidates_;
    std::vector<Displacement> displacements_;  // of meetings
    std::vector<DistanceCull> culls_;          // of lists
    std::vector<Chunk> chunks_;
    std::int64_t count_ = 0;
};

}  // namespace pent::contact
