#include "potentials/own_elements.h"

#include <limits>
#include <utility>

namespace pent::simulator {

bool is_held_and_strained(std::span<const std::uint32_t> corners, const Grips& grips) {
    const std::int32_t first = grips[corners.front()];
    bool is_rigid = first >= 0;
    for (const std::uint32_t corner : corners) {
        if (grips[corner] == kNoGrip) {
            return false;
        }
        is_rigid = is_rigid && grips[corner] == first;
    }
    return !is_rigid;
}

OwnAndShared elastic_elements(Eigen::Index begin,
                              Eigen::Index end,
                              const DofMap& dofs,
                              const Grips* grips,
                              const CornersOf& corners_of) {
    std::array<std::vector<std::pair<std::uint32_t, Eigen::Index>>, 2> keyed;
    for (Eigen::Index element = begin; element < end; ++element) {
        const std::span<const std::uint32_t> corners = corners_of(element);
        std::uint32_t lowest = std::numeric_limits<std::uint32_t>::max();
        std::uint32_t first = lowest;
        bool is_near = false;
        for (const std::uint32_t corner : corners) {
            lowest = std::min(lowest, dofs.index_of(corner));
            first = std::min(first, corner);
            is_near = is_near || dofs.is_own(corner);
        }
        const bool is_chosen =
            grips != nullptr ? is_held_and_strained(corners, *grips) : lowest < dofs.count();
        if (is_near && is_chosen) {
            keyed[dofs.is_own(first) ? 0 : 1].emplace_back(lowest, element);
        }
    }
    OwnAndShared chosen;
    for (std::size_t kind = 0; kind < 2; ++kind) {
        std::sort(keyed[kind].begin(), keyed[kind].end());
        chosen[kind].reserve(keyed[kind].size());
        for (const auto& [lowest, element] : keyed[kind]) {
            chosen[kind].push_back(element);
        }
    }
    return chosen;
}

}  // namespace pent::simulator
