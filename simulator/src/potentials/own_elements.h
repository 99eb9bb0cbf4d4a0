#pragma once

#include "linear/dof_map.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace pent::simulator {

/// Elements of this rank: those that count here, and those that another rank has, too, and counts.
using OwnAndShared = std::array<std::vector<Eigen::Index>, 2>;

/// Elements with a free corner and one of this rank, by their lowest dof, so that neighbors are
/// close. An element counts where its first vertex is at home.
///
/// @param corners_of  Calls its second argument with the corners of an element.
template <typename CornersOf>
OwnAndShared elastic_elements(Eigen::Index begin,
                              Eigen::Index end,
                              const DofMap& dofs,
                              const CornersOf& corners_of) {
    std::array<std::vector<std::pair<std::uint32_t, Eigen::Index>>, 2> keyed;
    for (Eigen::Index element = begin; element < end; ++element) {
        std::uint32_t lowest = std::numeric_limits<std::uint32_t>::max();
        std::uint32_t first = lowest;
        bool is_near = false;
        corners_of(element, [&](std::uint32_t corner) {
            lowest = std::min(lowest, dofs.index_of(corner));
            first = std::min(first, corner);
            is_near = is_near || dofs.is_own(corner);
        });
        if (is_near && lowest < dofs.count()) {
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

/// Sorts elements of each kind by a key within every so many, which leaves neighbors close.
template <typename KeyOf>
void sort_near(OwnAndShared& chosen, std::size_t size, const KeyOf& key_of) {
    for (std::vector<Eigen::Index>& elements : chosen) {
        for (std::size_t near = 0; near < elements.size(); near += size) {
            const std::size_t end = std::min(near + size, elements.size());
            std::stable_sort(elements.begin() + static_cast<std::ptrdiff_t>(near),
                             elements.begin() + static_cast<std::ptrdiff_t>(end),
                             [&](Eigen::Index a, Eigen::Index b) { return key_of(a) < key_of(b); });
        }
    }
}

/// Calls visit(elements, whether they count) for every so many elements of each kind.
template <typename Visit>
void for_each_chunk(const OwnAndShared& chosen, std::size_t size, const Visit& visit) {
    for (std::size_t kind = 0; kind < chosen.size(); ++kind) {
        const std::span<const Eigen::Index> all = chosen[kind];
        for (std::size_t first = 0; first < all.size(); first += size) {
            visit(all.subspan(first, std::min(size, all.size() - first)), kind == 0);
        }
    }
}

}  // namespace pent::simulator
