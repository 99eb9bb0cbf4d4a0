#include "linear/hierarchy.h"

#include "support/kuhn_box.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <utility>

namespace pent::simulator {
namespace {

using Links = std::set<std::pair<std::uint32_t, std::uint32_t>>;

// Both ways, and of each with itself.
Links links_of(const BlockPattern& pattern) {
    Links links;
    for (std::uint32_t row = 0; row < pattern.rows(); ++row) {
        for (std::int64_t k = pattern.row_start[row]; k < pattern.row_start[row + 1]; ++k) {
            const std::uint32_t column = pattern.columns[static_cast<std::size_t>(k)];
            links.insert({{row, column}, {column, row}});
        }
    }
    return links;
}

Links links_of(const AggregatePattern& pattern) {
    Links links;
    for (std::uint32_t row = 0; row < pattern.rows(); ++row) {
        for_each_in_row(pattern, row,
                        [&](std::uint32_t column, std::int64_t /*block*/, bool /*transposed*/) {
                            links.insert({row, column});
                        });
    }
    return links;
}

// Of the aggregates of what is linked.
Links lifted(const Links& links, const Aggregates& aggregates) {
    Links result;
    for (const auto& [a, b] : links) {
        result.insert({aggregates.of_child()[a], aggregates.of_child()[b]});
    }
    return result;
}

TEST(HierarchyTest, LinksAggregatesWhoseChildrenAreLinkedOnEveryLevel) {
    const SimplexMesh<4> mesh = pent::test::kuhn_box<4>({9, 5, 4, 4}, {9, 5, 4, 4});
    const std::vector<bool> is_held(static_cast<std::size_t>(mesh.vertex_count()), false);
    Columns alone;  // a column of every vertex
    for (std::uint32_t vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
        alone.columns.push_back(vertex);
        alone.layers.push_back(0);
    }
    const DofMap dofs = number_dofs<4>(mesh.cells, is_held, alone);
    const BlockPattern pattern = make_pattern<4>(mesh.cells, dofs);
    const std::vector<Aggregates> aggregates =
        make_hierarchy<4>(pattern, dofs.column_start(), at_dofs<4>(dofs, mesh.positions));
    const Hierarchy hierarchy(aggregates, pattern);
    ASSERT_EQ(hierarchy.levels.size(), aggregates.size());
    ASSERT_GT(hierarchy.levels.size(), 1U);
    EXPECT_EQ(hierarchy.halo.ghosts, nullptr);
    Links links = links_of(pattern);
    for (std::size_t l = 0; l < aggregates.size(); ++l) {
        const HierarchyLevel& level = hierarchy.levels[l];
        links = lifted(links, aggregates[l]);
        EXPECT_EQ(level.aggregates.of_child(), aggregates[l].of_child());
        EXPECT_EQ(level.pattern.rows(), aggregates[l].count());
        EXPECT_EQ(links_of(level.pattern), links);
        EXPECT_EQ(level.exchange, nullptr);
        EXPECT_TRUE(level.ghosts.columns.empty());
    }
}

}  // namespace
}  // namespace pent::simulator
