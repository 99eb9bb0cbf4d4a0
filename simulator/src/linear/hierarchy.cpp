#include "linear/hierarchy.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace pent::simulator {

namespace {

// Finds the ghost aggregates of a level, those with ghosts among their children, and numbers them
// behind the aggregates of this rank: by owner, then by their number there.
//
// @param children  Ghosts among the children, and their exchange.
void add_ghosts(const Ghosts& children, GhostExchange& exchange, HierarchyLevel& level) {
    std::vector<std::uint32_t> of_child = level.aggregates.of_child();
    const std::size_t columns =
        children.columns.empty() ? of_child.size() : children.columns.back() + std::size_t{1};
    of_child.resize(columns, 0);
    std::vector<double> told(of_child.begin(), of_child.end());
    exchange.update(told.data(), 1);
    using Home = std::pair<std::uint32_t, std::uint32_t>;  // the rank, and the number there
    std::vector<Home> homes;
    for (std::size_t i = 0; i < children.columns.size(); ++i) {
        homes.emplace_back(children.owners[i],
                           static_cast<std::uint32_t>(told[children.columns[i]]));
    }
    std::vector<Home> found = homes;
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    const auto own = static_cast<std::uint32_t>(level.aggregates.count());
    for (std::size_t i = 0; i < homes.size(); ++i) {
        const auto at = std::lower_bound(found.begin(), found.end(), homes[i]) - found.begin();
        of_child[children.columns[i]] = own + static_cast<std::uint32_t>(at);
    }
    level.aggregates.set_ghosts(std::move(of_child), static_cast<std::uint32_t>(found.size()));
    level.ghosts.own_columns = own;
    for (const Home& home : found) {
        level.ghosts.columns.push_back(own
                                       + static_cast<std::uint32_t>(level.ghosts.columns.size()));
        level.ghosts.owners.push_back(home.first);
        level.ghosts.places.push_back(home.second);
    }
}

}  // namespace

Hierarchy::Hierarchy(const std::vector<Aggregates>& aggregates,
                     const BlockPattern& pattern,
                     const BlockPattern* coupling,
                     const Halo& of_dofs,
                     const Ghosts& ghosts)
    : levels(aggregates.size()), halo(of_dofs) {
    for (std::size_t l = 0; l < levels.size(); ++l) {
        HierarchyLevel& level = levels[l];
        level.aggregates = aggregates[l];
        if (halo.ghosts != nullptr) {
            add_ghosts(l == 0 ? ghosts : levels[l - 1].ghosts,
                       l == 0 ? *halo.ghosts : *levels[l - 1].exchange, level);
            if (l + 1 < levels.size()) {
                level.exchange = halo.sharing->ranks().make_exchange(level.ghosts);
            }
        }
        level.pattern = l == 0 ? make_aggregate_pattern(level.aggregates, pattern, coupling)
                               : make_aggregate_pattern(level.aggregates, levels[l - 1].pattern);
    }
}

}  // namespace pent::simulator
