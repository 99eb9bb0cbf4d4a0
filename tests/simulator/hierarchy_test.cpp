#include "linear/hierarchy.h"

#include "aggregate_levels.h"
#include "cut_matrix.h"
#include "elastic_box.h"
#include "support/kuhn_box.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <memory>
#include <set>
#include <utility>
#include <vector>

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

// Aggregates that children of other ranks are in: what each rank calls a ghost is one of its
// owner's own, each once, on every level.
TEST(HierarchyTest, KnowsTheAggregatesOfOtherRanksByTheirOwnersNumbers) {
    constexpr int kRanks = 3;
    const test::ElasticBox<4> box(pent::test::kuhn_box<4>({3, 2, 2, 2}, {1, 1, 1, 1}),
                                  {.lame = {.lambda = 2, .mu = 1}}, ElementKind::Linear);
    const BlockMatrix<4, double> A(box.pattern);
    std::vector<std::uint32_t> owners;
    for (std::uint32_t dof = 0; dof < A.rows(); ++dof) {
        owners.push_back(dof * dof % 7 % kRanks);
    }
    std::array<std::vector<std::vector<std::uint32_t>>, kRanks> of_child;  // on each level
    std::array<std::vector<Ghosts>, kRanks> children;
    std::array<std::vector<Ghosts>, kRanks> ghosts;
    std::array<std::vector<int>, kRanks> counts;
    test::on_ranks(kRanks, [&](const std::shared_ptr<const Ranks>& ranks) {
        const auto rank = static_cast<std::size_t>(ranks->rank());
        const test::CutMatrix cut(A, owners, ranks);
        const Aggregates fine = test::by_number(static_cast<std::uint32_t>(cut.A->rows()), 4);
        const Aggregates coarse = test::by_number(static_cast<std::uint32_t>(fine.count()), 3);
        const Hierarchy hierarchy({fine, coarse}, cut.pattern, nullptr,
                                  {&cut.sharing, cut.exchange.get()}, cut.ghosts);
        EXPECT_NE(hierarchy.levels[0].exchange, nullptr);
        EXPECT_EQ(hierarchy.levels[1].exchange, nullptr);
        children[rank] = {cut.ghosts, hierarchy.levels[0].ghosts};
        for (const HierarchyLevel& level : hierarchy.levels) {
            of_child[rank].push_back(level.aggregates.of_child());
            ghosts[rank].push_back(level.ghosts);
            counts[rank].push_back(level.aggregates.count());
            EXPECT_EQ(level.aggregates.ghosts(), level.ghosts.columns.size());
        }
    });
    for (std::size_t rank = 0; rank < kRanks; ++rank) {
        for (std::size_t l = 0; l < 2; ++l) {
            const auto own = static_cast<std::uint32_t>(counts[rank][l]);
            const Ghosts& named = ghosts[rank][l];
            EXPECT_EQ(named.own_columns, own);
            std::set<std::pair<std::uint32_t, std::uint32_t>> homes;
            for (std::size_t i = 0; i < named.columns.size(); ++i) {
                EXPECT_EQ(named.columns[i], own + i);
                EXPECT_NE(named.owners[i], rank);
                EXPECT_TRUE(homes.emplace(named.owners[i], named.places[i]).second);
            }
            const Ghosts& below = children[rank][l];
            ASSERT_FALSE(below.columns.empty());
            std::set<std::uint32_t> used;
            for (std::size_t i = 0; i < below.columns.size(); ++i) {
                const std::uint32_t ghost = of_child[rank][l][below.columns[i]] - own;
                ASSERT_LT(ghost, named.columns.size());
                used.insert(ghost);
                EXPECT_EQ(named.owners[ghost], below.owners[i]);
                EXPECT_EQ(named.places[ghost], of_child[below.owners[i]][l][below.places[i]]);
            }
            EXPECT_EQ(used.size(), named.columns.size());
        }
    }
}

}  // namespace
}  // namespace pent::simulator
