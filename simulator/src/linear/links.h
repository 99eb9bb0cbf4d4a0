#pragma once

#include "linear/block_pattern.h"

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// Which nodes of a graph are neighbors: those of node i are targets[start[i]] ..
/// targets[start[i + 1] - 1], increasing, without i.
struct Links {
    std::vector<std::int64_t> start = {0};  ///< nodes + 1 entries.
    std::vector<std::uint32_t> targets;

    [[nodiscard]] std::size_t size() const { return start.size() - 1; }

    template <typename Visit>
    void for_each(std::uint32_t node, const Visit& visit) const {
        for (std::int64_t k = start[node]; k < start[node + 1]; ++k) {
            visit(targets[static_cast<std::size_t>(k)]);
        }
    }
};

/// The graph of a matrix: dofs that have rows are linked where they share a block.
[[nodiscard]] Links link_dofs(const BlockPattern& pattern);

/// The union of two graphs over the same nodes.
[[nodiscard]] Links join(const Links& a, const Links& b);

/// The quotient graph of a partition into parts 0 .. parts - 1: two are linked where a node of one
/// is linked to a node of the other.
///
/// @param part_of  The part of each node.
[[nodiscard]] Links link_parts(const Links& nodes,
                               const std::vector<std::uint32_t>& part_of,
                               std::size_t parts);

/// Greedy coloring: a color for each node, from 0, that none of its neighbors has.
[[nodiscard]] std::vector<std::uint32_t> color_nodes(const Links& links);

}  // namespace pent::simulator
