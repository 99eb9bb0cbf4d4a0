#pragma once

#include "linear/aggregate_matrix.h"
#include "linear/aggregates.h"
#include "linear/halo.h"

#include <memory>
#include <vector>

namespace pent::simulator {

/// The aggregates of one level of the multigrid hierarchy, the pattern of the matrix over them, and
/// their ghosts.
struct HierarchyLevel {
    Aggregates aggregates;  ///< Of this rank; of_child() and ghosts() know of ghosts, too.
    AggregatePattern pattern;
    Ghosts ghosts;  ///< Among the aggregates; none without ranks.
    /// Of vectors over the aggregates; null without ranks, and on the coarsest level.
    std::unique_ptr<GhostExchange> exchange;
};

/// All levels. No aggregate has children of two ranks, so that restriction and prolongation need no
/// messages.
class Hierarchy {
public:
    /// @param aggregates  Of this rank, the finest first; at least one level, as many on all ranks.
    /// @param pattern     Of the matrix over the dofs.
    /// @param coupling    Of its second part, or null.
    /// @param of_dofs     What it points to must outlive this.
    /// @param ghosts      Among the dofs, increasing; none without ranks.
    Hierarchy(const std::vector<Aggregates>& aggregates,
              const BlockPattern& pattern,
              const BlockPattern* coupling = nullptr,
              const Halo& of_dofs = {},
              const Ghosts& ghosts = {});

    std::vector<HierarchyLevel> levels;
    Halo halo;  ///< Of the dofs.
};

}  // namespace pent::simulator
