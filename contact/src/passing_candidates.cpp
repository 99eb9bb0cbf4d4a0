#include "passing_candidates.h"

#include <pent/dimensions.h>

namespace pent::contact {

template <int Dim>
PassingCandidates<Dim>::PassingCandidates(const Candidates<Dim>& candidates,
                                          const PositionsView<Dim>& from,
                                          const PositionsView<Dim>& to,
                                          double distance)
    : candidates_(candidates), displacements_(candidates.displacements(from, to)) {
    constexpr std::size_t kChunk = 512;
    const Colliders<Dim>& colliders = candidates.colliders();
    for (std::uint32_t list = 0; list < kLists * displacements_.size(); ++list) {
        const ListOfTwo of = list_at(pairs_of(list), list % kLists);
        const DistanceCull& cull = culls_.emplace_back(
            of.list, displacements_[list / kLists],
            distance + colliders.radius(of.first) + colliders.radius(of.second));
        for (std::size_t begin = 0; begin < cull.size(); begin += kChunk) {
            chunks_.push_back({list, begin, std::min(begin + kChunk, cull.size())});
        }
        count_ += static_cast<std::int64_t>(cull.size());
    }
}

#define PENT_INSTANTIATE(Dim) template class PassingCandidates<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
