#pragma once

#include "linear/block_pattern.h"
#include "linear/sharing.h"

#include <pent/simplex_mesh.h>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// A partition of children (dofs, or the aggregates of the level below) into connected, compact
/// pieces of about equal size.
///
/// Where dofs are shared those of other ranks may be numbered behind those of this one, children
/// and aggregates alike.
struct Aggregates {
    std::vector<std::uint32_t> of_child;              ///< Which aggregate a child belongs to.
    std::vector<std::vector<std::uint32_t>> members;  ///< Children of each, increasing.
    std::uint32_t ghosts = 0;                         ///< Aggregates of others: without members.

    /// Of this rank.
    [[nodiscard]] int count() const { return static_cast<int>(members.size()); }
};

/// Most aggregates at which a hierarchy ends, unless they share no link.
inline constexpr int kCoarsestAggregates = 24;

/// Aggregates of about 29 dofs each, aggregates of about 6 of these, and so on until few are left.
///
/// Clusters of whole columns, single dofs where a mesh knows none, grow from a seed beside those
/// that are there, along links of the matrix, always by what is nearest to their middle; then
/// borders move until they are halfway between middles, for ragged ones lock where a body bends.
/// Each is then cut across in parts about twice as long as wide, thin layers not at all: these are
/// the finest aggregates. Arms of a body that lie side by side never share one, as pieces of space
/// would make them. What has no link to others stays alone. Those that share no link follow one
/// another, by color.
///
/// Where dofs are shared each rank has aggregates of its own dofs, and all have as many levels.
///
/// @param pattern       Links of the dofs that have rows; columns of others are left out.
/// @param column_start  As DofMap::column_start().
/// @param rest          Dim x dofs, rest positions, m.
/// @param sharing       Null where nothing is shared.
/// @return              The finest first; at least one level, which is empty without dofs.
template <int Dim>
[[nodiscard]] std::vector<Aggregates> make_hierarchy(const BlockPattern& pattern,
                                                     const std::vector<std::uint32_t>& column_start,
                                                     const Positions<Dim>& rest,
                                                     const Sharing* sharing = nullptr);

}  // namespace pent::simulator
