#include "linear/links.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace pent::simulator {
namespace {

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

// Upper triangle with random blocks.
BlockPattern random_pattern(std::uint32_t rows, double density) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform;
    BlockPattern pattern;
    for (std::uint32_t row = 0; row < rows; ++row) {
        pattern.row_start.push_back(static_cast<std::int64_t>(pattern.columns.size()));
        pattern.columns.push_back(row);
        for (std::uint32_t column = row + 1; column < rows; ++column) {
            if (uniform(random) < density) {
                pattern.columns.push_back(column);
            }
        }
    }
    pattern.row_start.push_back(static_cast<std::int64_t>(pattern.columns.size()));
    return pattern;
}

// Both ways round.
Pairs pairs_of(const Links& links) {
    Pairs pairs;
    for (std::uint32_t node = 0; node < links.size(); ++node) {
        links.for_each(node, [&](std::uint32_t other) { pairs.emplace(node, other); });
    }
    return pairs;
}

Pairs pairs_of(const BlockPattern& pattern) {
    Pairs pairs;
    for (std::uint32_t row = 0; row < pattern.rows(); ++row) {
        for (std::int64_t k = pattern.row_start[row] + 1; k < pattern.row_start[row + 1]; ++k) {
            const std::uint32_t column = pattern.columns[static_cast<std::size_t>(k)];
            pairs.emplace(row, column);
            pairs.emplace(column, row);
        }
    }
    return pairs;
}

TEST(Links, AreThePairsOfDofsThatShareABlockBothWaysRoundAndInOrder) {
    const BlockPattern pattern = random_pattern(40, 0.1);
    const Links links = link_dofs(pattern);
    ASSERT_EQ(links.size(), 40U);
    EXPECT_EQ(pairs_of(links), pairs_of(pattern));
    EXPECT_EQ(links.targets.size(), pairs_of(pattern).size());  // each once
    for (std::size_t node = 0; node < links.size(); ++node) {
        EXPECT_TRUE(std::is_sorted(links.targets.begin() + links.start[node],
                                   links.targets.begin() + links.start[node + 1]));
    }
}

TEST(Links, OfPartsAreThoseOfTheirNodesButNoneOfAPartToItself) {
    const Links links = link_dofs(random_pattern(40, 0.1));
    std::vector<std::uint32_t> part_of;
    for (std::uint32_t node = 0; node < 40; ++node) {
        part_of.push_back(node * 7 % 11);
    }
    Pairs expected;
    for (const auto& [a, b] : pairs_of(links)) {
        if (part_of[a] != part_of[b]) {
            expected.emplace(part_of[a], part_of[b]);
        }
    }
    EXPECT_EQ(pairs_of(link_parts(links, part_of, 11)), expected);
}

TEST(ColorNodes, GivesNeighborsColorsOfTheirOwnAndNoMoreThanOneAboveTheMostNeighbors) {
    for (const double density : {0.0, 0.1, 0.5, 1.0}) {
        const Links links = link_dofs(random_pattern(40, density));
        const std::vector<std::uint32_t> colors = color_nodes(links);
        std::int64_t most = 0;
        for (std::uint32_t node = 0; node < links.size(); ++node) {
            links.for_each(node,
                           [&](std::uint32_t other) { EXPECT_NE(colors[node], colors[other]); });
            most = std::max(most, links.start[node + 1] - links.start[node]);
        }
        EXPECT_LE(*std::max_element(colors.begin(), colors.end()), most);
    }
}

TEST(ColorNodes, TakesTwoColorsForAChain) {
    BlockPattern chain;
    for (std::uint32_t row = 0; row < 9; ++row) {
        chain.row_start.push_back(static_cast<std::int64_t>(chain.columns.size()));
        chain.columns.push_back(row);
        if (row < 8) {
            chain.columns.push_back(row + 1);
        }
    }
    chain.row_start.push_back(static_cast<std::int64_t>(chain.columns.size()));
    const std::vector<std::uint32_t> colors = color_nodes(link_dofs(chain));
    for (std::uint32_t node = 0; node < 9; ++node) {
        EXPECT_EQ(colors[node], node % 2);
    }
}

}  // namespace
}  // namespace pent::simulator
