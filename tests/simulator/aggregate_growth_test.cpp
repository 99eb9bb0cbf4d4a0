#include "linear/aggregate_growth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace pent::simulator {
namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

// Nodes 1 m apart on a line, of weight 1, with links of their own.
AggregateNodes<3> nodes_of(std::uint32_t count, const Pairs& links) {
    BlockPattern pattern;
    for (std::uint32_t row = 0; row < count; ++row) {
        pattern.row_start.push_back(static_cast<std::int64_t>(pattern.columns.size()));
        pattern.columns.push_back(row);
        for (const auto& [a, b] : links) {
            if (a == row) {
                pattern.columns.push_back(b);
            }
        }
        std::sort(pattern.columns.begin() + pattern.row_start.back(), pattern.columns.end());
    }
    pattern.row_start.push_back(static_cast<std::int64_t>(pattern.columns.size()));
    AggregateNodes<3> nodes{link_dofs(pattern), Positions<3>::Zero(3, count),
                            std::vector<double>(count, 1.0), std::vector<double>(count, 1.0)};
    for (std::uint32_t node = 0; node < count; ++node) {
        nodes.places(0, node) = node;
    }
    return nodes;
}

Pairs chain(std::uint32_t first, std::uint32_t last) {
    Pairs links;
    for (std::uint32_t node = first; node < last; ++node) {
        links.emplace_back(node, node + 1);
    }
    return links;
}

// Whatever their numbers are: by their first nodes.
std::vector<std::uint32_t> pieces_of(const Aggregates& aggregates) {
    std::map<std::uint32_t, std::uint32_t> first;
    std::vector<std::uint32_t> pieces;
    for (const std::uint32_t aggregate : aggregates.of_child()) {
        const auto next = static_cast<std::uint32_t>(pieces.size());
        pieces.push_back(first.emplace(aggregate, next).first->second);
    }
    EXPECT_EQ(first.size(), static_cast<std::size_t>(aggregates.count()));
    return pieces;
}

std::vector<std::uint32_t> blocks(std::uint32_t count, std::uint32_t size) {
    std::vector<std::uint32_t> pieces;
    for (std::uint32_t node = 0; node < count; ++node) {
        pieces.push_back(node / size * size);
    }
    return pieces;
}

TEST(GrowAggregates, CutsAChainIntoPiecesOfTheSizeAskedFor) {
    EXPECT_EQ(pieces_of(grow_aggregates(nodes_of(20, chain(0, 19)), 5)), blocks(20, 5));
    AggregateNodes<3> heavy = nodes_of(20, chain(0, 19));
    heavy.weights.assign(20, 2.5);
    EXPECT_EQ(pieces_of(grow_aggregates(heavy, 5)), blocks(20, 2));
}

// Two that nothing links, side by side.
TEST(GrowAggregates, NeverCrossesWhereThereIsNoLink) {
    Pairs links = chain(0, 4);
    for (const auto& link : chain(5, 14)) {
        links.push_back(link);
    }
    EXPECT_EQ(pieces_of(grow_aggregates(nodes_of(15, links), 10)),
              (std::vector<std::uint32_t>{0, 0, 0, 0, 0, 5, 5, 5, 5, 5, 5, 5, 5, 5, 5}));
}

// Nodes 0 to 3 and 6 to 9 are pieces that are there; 4 has two links to the first and one to the
// second, 5 one to the first and two to the second.
TEST(MendAggregates, JoinsWhatIsSmallToWhatItHasMostLinksWith) {
    Pairs links = chain(0, 9);
    links.erase(links.begin() + 4);  // between 4 and 5
    for (const auto& link : Pairs{{2, 4}, {4, 6}, {3, 5}, {5, 7}}) {
        links.push_back(link);
    }
    const std::vector<std::uint32_t> pieces = {0, 0, 0, 0, 1, 2, 3, 3, 3, 3};
    EXPECT_EQ(pieces_of(mend_aggregates(nodes_of(10, links), 6, pieces)),
              (std::vector<std::uint32_t>{0, 0, 0, 0, 0, 5, 5, 5, 5, 5}));
}

// Less than a third of an aggregate is small.
TEST(MendAggregates, LeavesWhatIsNotSmall) {
    for (const std::uint32_t least : {9U, 10U}) {
        std::vector<std::uint32_t> pieces(40, 1);
        std::fill_n(pieces.begin(), least, 0);
        const Aggregates mended = mend_aggregates(nodes_of(40, chain(0, 39)), 30, pieces);
        EXPECT_EQ(mended.count(), least == 9 ? 1 : 2);
    }
}

TEST(MendAggregates, TakesApartWhatDoesNotHangTogether) {
    std::vector<std::uint32_t> pieces(12, 1);
    std::fill_n(pieces.begin() + 4, 4, 0);
    EXPECT_EQ(pieces_of(mend_aggregates(nodes_of(12, chain(0, 11)), 4, pieces)), blocks(12, 4));
}

// What is small and has no link is left alone.
TEST(MendAggregates, JoinsNothingToWhatHasNoLinks) {
    EXPECT_EQ(pieces_of(mend_aggregates(nodes_of(3, {}), 30, {0, 0, 1})), blocks(3, 1));
}

}  // namespace
}  // namespace pent::simulator
