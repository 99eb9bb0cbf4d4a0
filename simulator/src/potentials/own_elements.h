#pragma once

#include "linear/dof_map.h"
#include "model/grips.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace pent::simulator {

/// Elements of this rank: those that count here, and those that another rank has, too, and counts.
using OwnAndShared = std::array<std::vector<Eigen::Index>, 2>;

/// Whether an element has all corners held, and may be strained nevertheless: not by one constraint
/// that moves all of them as a rigid body.
[[nodiscard]] bool is_held_and_strained(std::span<const std::uint32_t> corners, const Grips& grips);

/// The corners of an element.
using CornersOf = std::function<std::span<const std::uint32_t>(Eigen::Index element)>;

/// Elements with a dof and a corner of this rank, by their lowest dof, so that neighbors are close.
/// An element counts where its first vertex is at home.
///
/// @param grips  If not null, those that are held and strained in place of those with a dof.
[[nodiscard]] OwnAndShared elastic_elements(Eigen::Index begin,
                                            Eigen::Index end,
                                            const DofMap& dofs,
                                            const Grips* grips,
                                            const CornersOf& corners_of);

/// Sorts elements of each kind by a key, but only within stretches of `size`, which leaves
/// neighbors close.
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

/// Calls visit(elements, whether they count) for stretches of at most `size` elements of each kind.
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
