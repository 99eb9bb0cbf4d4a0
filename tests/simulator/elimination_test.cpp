#include "linear/elimination.h"

#include "linear/block_pattern.h"
#include "support/kuhn_box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace pent::simulator {
namespace {

using Filled = Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic>;

// Which entries of the factor are not zero, by elimination of every column of a dense matrix.
Filled fill_in(const Links& links, const std::vector<std::uint32_t>& order) {
    const auto size = static_cast<Eigen::Index>(links.size());
    std::vector<Eigen::Index> place(links.size());
    for (Eigen::Index k = 0; k < size; ++k) {
        place[order[static_cast<std::size_t>(k)]] = k;
    }
    Filled filled = Filled::Identity(size, size);
    for (std::uint32_t node = 0; node < links.size(); ++node) {
        links.for_each(node,
                       [&](std::uint32_t other) { filled(place[node], place[other]) = true; });
    }
    for (Eigen::Index k = 0; k < size; ++k) {
        for (Eigen::Index i = k + 1; i < size; ++i) {
            for (Eigen::Index j = k + 1; filled(i, k) && j < size; ++j) {
                filled(i, j) = filled(i, j) || filled(j, k);
            }
        }
    }
    return filled;
}

// Every entry of the factor has a place, each column is in one supernode, and updates go to a
// supernode that has places for them.
void expect_room_for_the_factor(const Links& links, const Elimination& elimination) {
    const Filled filled = fill_in(links, elimination.order);
    std::uint32_t next = 0;
    for (std::size_t s = 0; s < elimination.supernodes.size(); ++s) {
        const Supernode& node = elimination.supernodes[s];
        ASSERT_EQ(node.begin, next);
        next += node.width;
        ASSERT_TRUE(std::is_sorted(node.rows.begin(), node.rows.end()));
        const auto has = [&](const Supernode& of, std::uint32_t row) {
            return (row >= of.begin && row < of.begin + of.width)
                   || std::binary_search(of.rows.begin(), of.rows.end(), row);
        };
        for (std::uint32_t column = node.begin; column < next; ++column) {
            for (std::uint32_t row = column; row < filled.rows(); ++row) {
                ASSERT_TRUE(!filled(row, column) || has(node, row)) << row << ' ' << column;
            }
        }
        ASSERT_EQ(node.parent < 0, node.rows.empty());
        for (const std::uint32_t row : node.rows) {
            ASSERT_GT(node.parent, static_cast<std::int64_t>(s));
            ASSERT_GE(row, next);
            ASSERT_TRUE(has(elimination.supernodes[static_cast<std::size_t>(node.parent)], row));
        }
    }
    ASSERT_EQ(next, links.size());
}

// Random links among some nodes, of which the last have none at all.
Links random_links(std::uint32_t nodes, double density, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform;
    BlockPattern pattern;
    pattern.row_start = {0};
    for (std::uint32_t row = 0; row < nodes; ++row) {
        pattern.columns.push_back(row);
        for (std::uint32_t column = row + 1; column < nodes * 9 / 10; ++column) {
            if (uniform(random) < density) {
                pattern.columns.push_back(column);
            }
        }
        pattern.row_start.push_back(static_cast<std::int64_t>(pattern.columns.size()));
    }
    return link_dofs(pattern);
}

TEST(Elimination, HasAPlaceForEveryEntryOfTheFactorInAnyOrder) {
    for (const double density : {0.0, 0.01, 0.03, 0.1, 0.5}) {
        for (unsigned seed = 1; seed <= 5; ++seed) {
            const Links links = random_links(60, density, seed);
            std::vector<std::uint32_t> order(links.size());
            std::iota(order.begin(), order.end(), 0U);
            std::shuffle(order.begin(), order.end(), std::mt19937(seed));
            expect_room_for_the_factor(links, eliminate(links, order));
        }
    }
}

// Where a supernode is made there are the columns of all up to it, and of each of them that its
// parent has not taken yet the update, a square of its rows.
void expect_costs(const Elimination& elimination) {
    std::int64_t factor = 0;
    std::int64_t most = 0;
    for (std::size_t made = 0; made < elimination.supernodes.size(); ++made) {
        const auto width = static_cast<std::int64_t>(elimination.supernodes[made].width);
        const auto rows = static_cast<std::int64_t>(elimination.supernodes[made].rows.size());
        factor += width * (width + rows);
        std::int64_t updates = 0;
        for (std::size_t before = 0; before <= made; ++before) {
            const Supernode& node = elimination.supernodes[before];
            const auto size = static_cast<std::int64_t>(node.rows.size());
            updates += node.parent >= static_cast<std::int64_t>(made) ? size * size : 0;
        }
        most = std::max(most, factor + updates);
    }
    EXPECT_EQ(elimination.blocks, factor);
    EXPECT_EQ(elimination.peak_blocks, most);
}

TEST(Elimination, TakesEveryDofOnceWhereverTheyLie) {
    const Links links = random_links(200, 0.02, 1);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform;
    Eigen::MatrixXd spread = Eigen::MatrixXd::NullaryExpr(4, 200, [&] { return uniform(random); });
    const Eigen::MatrixXd in_one_place = Eigen::MatrixXd::Constant(4, 200, 0.5);
    Eigen::MatrixXd most_in_one_place = in_one_place;
    most_in_one_place.rightCols(20) = spread.rightCols(20);
    for (const Eigen::MatrixXd& places : {spread, in_one_place, most_in_one_place}) {
        const Elimination elimination = eliminate(links, places);
        std::vector<std::uint32_t> all = elimination.order;
        std::sort(all.begin(), all.end());
        for (std::uint32_t dof = 0; dof < 200; ++dof) {
            ASSERT_EQ(all[dof], dof);
            ASSERT_EQ(elimination.order[elimination.place[dof]], dof);
        }
        expect_room_for_the_factor(links, elimination);
        expect_costs(elimination);
    }
    EXPECT_TRUE(eliminate(random_links(0, 0, 1), Eigen::MatrixXd(4, 0)).order.empty());
}

// Of n^3 vertices a dense factor has n^6 / 2 blocks, one by dissection about n^4.
TEST(Elimination, FillsFarLessThanTheBandOfABox) {
    const SimplexMesh<3> mesh = pent::test::kuhn_box<3>({10, 10, 10}, {1, 1, 1});
    const auto size = static_cast<std::uint32_t>(mesh.vertex_count());
    std::vector<std::uint32_t> all(size);
    std::iota(all.begin(), all.end(), 0U);
    const BlockPattern pattern =
        make_pattern<3>(mesh.cells, DofMap(size, all, std::vector<std::uint32_t>{0, size}));
    const Links links = link_dofs(pattern);
    const Elimination dissected = eliminate(links, mesh.positions);
    const Elimination in_order = eliminate(links, all);
    EXPECT_LT(dissected.blocks, 8 * 1e4 * 2);
    EXPECT_LT(2 * dissected.products, in_order.products);
    expect_costs(dissected);
    expect_costs(in_order);
}

// A ladder numbered from end to end is best left so; numbered at random it is cut.
TEST(Elimination, KeepsTheOrderOfALadderAndCutsWhatHasNone) {
    constexpr std::uint32_t kWide = 4;
    constexpr std::uint32_t kCount = 100 * kWide;
    std::vector<std::uint32_t> number(kCount);
    std::iota(number.begin(), number.end(), 0U);
    for (const bool is_in_order : {true, false}) {
        if (!is_in_order) {
            std::shuffle(number.begin(), number.end(), std::mt19937(1));
        }
        std::vector<std::vector<std::uint32_t>> linked(kCount);
        const auto link = [&](std::uint32_t i, std::uint32_t j) {
            linked[number[i]].push_back(number[j]);
            linked[number[j]].push_back(number[i]);
        };
        Eigen::MatrixXd places(3, kCount);
        for (std::uint32_t i = 0; i < kCount; ++i) {
            places.col(number[i]) = Eigen::Vector3d(i / kWide, i % kWide, 0);
            if (i >= kWide) {
                link(i, i - kWide);
            }
            if (i % kWide > 0) {
                link(i, i - 1);
            }
        }
        Links links;
        for (std::vector<std::uint32_t>& of_node : linked) {
            std::sort(of_node.begin(), of_node.end());
            links.targets.insert(links.targets.end(), of_node.begin(), of_node.end());
            links.start.push_back(static_cast<std::int64_t>(links.targets.size()));
        }
        std::vector<std::uint32_t> as_numbered(kCount);
        std::iota(as_numbered.begin(), as_numbered.end(), 0U);
        const Elimination chosen = eliminate(links, places);
        const Elimination plain = eliminate(links, as_numbered);
        expect_room_for_the_factor(links, chosen);
        expect_costs(chosen);
        EXPECT_EQ(chosen.order == plain.order, is_in_order);
        EXPECT_EQ(chosen.products == plain.products, is_in_order);
        EXPECT_LE(chosen.products, plain.products);
    }
}

}  // namespace
}  // namespace pent::simulator
