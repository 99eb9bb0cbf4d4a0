#pragma once

#include "linear/aggregate_matrix.h"
#include "linear/aggregates.h"
#include "linear/halo.h"

#include <memory>
#include <vector>

namespace pent::simulator {

/// Aggregates of a level, which blocks their matrix has, and what of it is of other ranks.
struct HierarchyLevel {
    Aggregates aggregates;  ///< Of this rank; of_child() tells of those of others, too.
    AggregatePattern pattern;
    Ghosts ghosts;  ///< Those of others; none where nothing is shared.
    /// Of vectors over the aggregates; null where nothing is shared, and for the coarsest level.
    std::unique_ptr<GhostExchange> exchange;
};

/// Aggregates of the dofs over all levels. None crosses from one rank to another.
class Hierarchy {
public:
    /// @param aggregates  Of this rank, the finest first; at least one level, as many on all ranks.
    /// @param pattern     Of the matrix.
    /// @param coupling    Of its second part, or null.
    /// @param of_dofs     Must outlive this.
    /// @param ghosts      Of the matrix, increasing; none where nothing is shared.
    Hierarchy(const std::vector<Aggregates>& aggregates,
              const BlockPattern& pattern,
              const BlockPattern* coupling = nullptr,
              const Halo& of_dofs = {},
              const Ghosts& ghosts = {});

    std::vector<HierarchyLevel> levels;
    Halo halo;  ///< Of the dofs.
};

}  // namespace pent::simulator
