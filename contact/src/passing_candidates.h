#pragma once

#include "candidates.h"
#include "chunks.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pent::contact {

/// Where a candidate is from: its list, counted on through all lists of all meetings, and the
/// colliders that its two simplices belong to.
struct ListPlace {
    std::uint32_t list = 0;
    int first = 0;
    int second = 0;
};

/// What was found of candidates: a part for each chunk of them, in their order.
template <typename Part>
struct OfPassing {
    std::vector<Part> parts;
    std::int64_t looked_at = 0;
};

/// Looks at the candidates that may come within a distance on the way between two positions: chunks
/// of all lists at the same time, since small bodies have short lists.
///
/// @param within  within(first, second): that distance for the simplices of two colliders, m.
/// @param look    look.operator()<K, L>(place, pair, part): adds to the part of its chunk, which
///                begins as a Part().
template <typename Part, int Dim, typename Within, typename Look>
[[nodiscard]] OfPassing<Part> look_at_passing(const Candidates<Dim>& candidates,
                                              const PositionsView<Dim>& from,
                                              const PositionsView<Dim>& to,
                                              const Within& within,
                                              const Look& look) {
    constexpr std::size_t kChunk = 512;
    const Colliders<Dim>& colliders = candidates.colliders();
    const Meetings<Dim>& meetings = candidates.meetings();
    const std::vector<Displacement> displacements = candidates.displacements(from, to);
    // Calls visit<K, L>(list, cull, place).
    const auto visit_culled = [&](std::uint32_t place, const auto& visit) {
        const std::uint32_t m = place / kLists;
        visit_list<Dim>(
            meetings[m].pairs, static_cast<int>(place % kLists),
            [&]<int K, int L>(const CandidateList& list, int first, int second) {
                const DistanceCull<K, L> cull(list,
                                              colliders.surface(first).template simplices<K>(),
                                              colliders.surface(second).template simplices<L>(),
                                              displacements[m], within(first, second));
                visit.template operator()<K, L>(list, cull, ListPlace{place, first, second});
            });
    };
    struct Chunk {
        std::uint32_t list = 0;
        std::size_t begin = 0;
    };
    std::vector<Chunk> chunks;
    OfPassing<Part> found;
    for (std::uint32_t list = 0; list < kLists * meetings.size(); ++list) {
        visit_culled(list, [&]<int K, int L>(const CandidateList&, const DistanceCull<K, L>& cull,
                                             const ListPlace&) {
            for (std::size_t begin = 0; begin < cull.size(); begin += kChunk) {
                chunks.push_back({list, begin});
            }
            found.looked_at += static_cast<std::int64_t>(cull.size());
        });
    }
    found.parts.resize(chunks.size());
    parallel_for(chunks.size(), [&](std::size_t c) {
        const std::size_t begin = chunks[c].begin;
        visit_culled(chunks[c].list, [&]<int K, int L>(const CandidateList& list,
                                                       const DistanceCull<K, L>& cull,
                                                       const ListPlace& place) {
            const std::size_t end = std::min(begin + kChunk, cull.size());
            for (std::size_t k = begin; k < end; ++k) {
                if (cull.passes(k)) {
                    look.template operator()<K, L>(place, list.pairs[k], found.parts[c]);
                }
            }
        });
    });
    return found;
}

}  // namespace pent::contact
