#include "linear/aggregates.h"

#include "cut_matrix.h"
#include "elastic_box.h"
#include "linear/aggregate_matrix.h"
#include "support/kuhn_box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <random>
#include <set>
#include <span>
#include <utility>

namespace pent::simulator {
namespace {

struct Box {
    SimplexMesh<4> mesh;
    DofMap dofs;
    BlockPattern pattern;
    Positions<4> rest;

    Box(const std::array<int, 4>& count, const std::array<double, 4>& size)
        : mesh(pent::test::kuhn_box<4>(count, size)) {
        const auto base =
            static_cast<std::uint32_t>((count[0] + 1) * (count[1] + 1) * (count[2] + 1));
        Columns columns;
        for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
            columns.columns.push_back(v % base);
            columns.layers.push_back(v / base);
        }
        const std::vector<bool> is_held(static_cast<std::size_t>(mesh.vertex_count()), false);
        dofs = number_dofs<4>(mesh.cells, is_held, columns);
        pattern = make_pattern<4>(mesh.cells, dofs);
        rest = at_dofs<4>(dofs, mesh.positions);
    }

    [[nodiscard]] std::vector<Aggregates> hierarchy() const {
        return make_hierarchy<4>(pattern, dofs.column_start(), rest);
    }
};

std::size_t number_of(const Aggregates& aggregates) {
    return static_cast<std::size_t>(aggregates.count());
}

void expect_partition(const Aggregates& aggregates, std::size_t children) {
    ASSERT_EQ(aggregates.of_child().size(), children);
    EXPECT_EQ(aggregates.children(), children);
    std::size_t total = 0;
    for (std::uint32_t a = 0; a < number_of(aggregates); ++a) {
        const auto members = aggregates.members(a);
        EXPECT_FALSE(members.empty());
        EXPECT_TRUE(std::is_sorted(members.begin(), members.end()));
        total += members.size();
        for (const std::uint32_t child : members) {
            EXPECT_EQ(aggregates.of_child()[child], a);
        }
    }
    EXPECT_EQ(total, children);
}

TEST(AggregatesTest, FollowOneAnotherByTheirFirstMembers) {
    const Aggregates aggregates({3, 3, 0, 1, 0, 3, 2, 1}, 4);
    EXPECT_EQ(aggregates.count(), 4);
    expect_partition(aggregates, 8);
    EXPECT_EQ(aggregates.first_of(3), 0U);
    EXPECT_EQ(aggregates.first_of(0), 3U);
    EXPECT_EQ(aggregates.first_of(1), 5U);
    EXPECT_EQ(aggregates.first_of(2), 7U);
    std::vector<std::uint32_t> order;
    aggregates.for_each(Workers(1), [&](std::uint32_t a) { order.push_back(a); });
    EXPECT_EQ(order, (std::vector<std::uint32_t>{3, 0, 1, 2}));
}

// Whether or not the last part is full.
TEST(AggregatesTest, AreGoneOverOnceEachByAnyNumberOfThreads) {
    for (const std::uint32_t count : {1U, 63U, 64U, 65U, 500U}) {
        std::vector<std::uint32_t> of_child;
        for (std::uint32_t child = 0; child < 3 * count; ++child) {
            of_child.push_back(count - 1 - child % count);
        }
        const Aggregates aggregates(of_child, count);
        for (const int threads : {1, 3}) {
            std::vector<int> visits(count);
            aggregates.for_each(Workers(threads), [&](std::uint32_t a) { ++visits[a]; });
            EXPECT_EQ(visits, std::vector<int>(count, 1));
        }
    }
    Aggregates().for_each(Workers(2), [](std::uint32_t a) { FAIL() << a; });
}

// Dofs of the set that can be reached from its first without leaving it.
std::size_t reached(const BlockPattern& pattern, std::span<const std::uint32_t> set) {
    std::set<std::uint32_t> left(set.begin() + 1, set.end());
    std::vector<std::uint32_t> queue = {set[0]};
    for (std::size_t next = 0; next < queue.size(); ++next) {
        for (auto other = left.begin(); other != left.end();) {
            const std::uint32_t a = std::min(queue[next], *other);
            const std::uint32_t b = std::max(queue[next], *other);
            const auto columns = pattern.columns.begin();
            if (std::binary_search(columns + pattern.row_start[a],
                                   columns + pattern.row_start[a + 1], b)) {
                queue.push_back(*other);
                other = left.erase(other);
            } else {
                ++other;
            }
        }
    }
    return queue.size();
}

TEST(MakeHierarchy, PartitionsEveryLevelIntoConnectedPiecesOfBoundedSize) {
    const Box box({12, 6, 4, 4}, {12, 6, 4, 4});
    const std::vector<Aggregates> levels = box.hierarchy();
    ASSERT_EQ(levels.size(), 2U);  // of 2275 dofs, 78 and 13 aggregates or so
    auto children = static_cast<std::size_t>(box.pattern.rows());
    for (const Aggregates& level : levels) {
        expect_partition(level, children);
        EXPECT_LT(3 * number_of(level), children);
        children = number_of(level);
    }
    EXPECT_LE(levels.back().count(), kCoarsestAggregates);
    for (std::size_t a = 0; a < number_of(levels[0]); ++a) {
        const auto members = levels[0].members(a);
        EXPECT_EQ(reached(box.pattern, members), members.size());
        EXPECT_LE(members.size(), 2U * 29);  // and what was left over beside it
    }
}

int cut_links(const Box& box) {
    const std::vector<Aggregates> levels = box.hierarchy();
    const auto& start = box.dofs.column_start();
    int cut = 0;
    for (std::size_t column = 0; column + 1 < start.size(); ++column) {
        for (std::uint32_t dof = start[column]; dof + 1 < start[column + 1]; ++dof) {
            cut += levels[0].of_child()[dof] != levels[0].of_child()[dof + 1] ? 1 : 0;
        }
    }
    return cut;
}

// Layers of a twentieth: a column is thinner than its cells are wide.
TEST(MakeHierarchy, CutsNoColumnOfThinLayers) {
    EXPECT_EQ(cut_links(Box({6, 4, 4, 5}, {6, 4, 4, 0.25})), 0);
}

// 32 layers of a quarter: parts of columns that are about twice as long as aggregates are wide, so
// that of the 32 links of a column at most those between its parts are cut.
TEST(MakeHierarchy, CutsThinLayersOnlyBetweenPartsLongerThanTheMeshIsFine) {
    const Box box({4, 4, 4, 32}, {4, 4, 4, 8});
    const auto columns = static_cast<int>(box.dofs.column_start().size()) - 1;
    EXPECT_LE(cut_links(box), 3 * columns);
    EXPECT_GT(cut_links(box), 0);
}

// Of every aggregate, all columns begin at one layer and end at one layer.
TEST(MakeHierarchy, LetsAggregatesMeetInPlanesAcrossTheColumns) {
    const Box box({8, 6, 6, 15}, {8, 6, 6, 15});
    const auto& start = box.dofs.column_start();
    const Aggregates level = box.hierarchy()[0];
    std::vector<std::uint32_t> parts(box.dofs.count());  // of its column, from the bottom
    for (std::size_t column = 0; column + 1 < start.size(); ++column) {
        for (std::uint32_t dof = start[column] + 1; dof < start[column + 1]; ++dof) {
            parts[dof] =
                parts[dof - 1] + (level.of_child()[dof] != level.of_child()[dof - 1] ? 1 : 0);
            EXPECT_EQ(parts[dof], parts[dof - start[column]]);  // as in the first column
        }
    }
    EXPECT_EQ(parts[start[1] - 1], 3U);  // 16 layers: about 4 by 2.45 by 2.45 by 2.45
}

// Borders are halfway between middles: no vertex is nearer to the middle of a neighbor, but where
// a last round left something to move.
TEST(MakeHierarchy, GivesNearlyEveryVertexToTheNearestMiddleBesideIt) {
    const Box box({10, 8, 6, 4}, {10, 8, 6, 4});
    const Aggregates level = box.hierarchy()[0];
    Positions<4> middles = Positions<4>::Zero(4, level.count());
    for (int a = 0; a < level.count(); ++a) {
        const auto members = level.members(static_cast<std::size_t>(a));
        for (const std::uint32_t dof : members) {
            middles.col(a) += box.rest.col(dof) / static_cast<double>(members.size());
        }
    }
    int misplaced = 0;
    for (std::uint32_t row = 0; row < box.pattern.rows(); ++row) {
        for (std::int64_t k = box.pattern.row_start[row]; k < box.pattern.row_start[row + 1]; ++k) {
            const std::uint32_t column = box.pattern.columns[static_cast<std::size_t>(k)];
            const auto distance = [&](std::uint32_t a) {
                return (box.rest.col(row) - middles.col(a)).norm();
            };
            misplaced += distance(level.of_child()[column]) < 0.9 * distance(level.of_child()[row]);
        }
    }
    EXPECT_LT(misplaced, box.pattern.rows() / 50);
}

// In a grid many are equally near. Instruction sets and compilers round distances in their own
// ways, and all must make the same preconditioner of it.
TEST(MakeHierarchy, IsTheSameWhereRoundingIsAnother) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> noise(-1e-14, 1e-14);
    for (const std::array<int, 4>& count :
         {std::array{8, 4, 4, 4}, std::array{4, 4, 4, 4}, std::array{6, 2, 6, 2}}) {
        Box box(count, {4, 2, 2, 2});
        const std::vector<Aggregates> expected = box.hierarchy();
        for (int round = 0; round < 20; ++round) {
            Box moved = box;
            moved.rest = box.rest.unaryExpr([&](double x) { return x + noise(random); });
            const std::vector<Aggregates> levels = moved.hierarchy();
            ASSERT_EQ(levels.size(), expected.size());
            for (std::size_t level = 0; level < levels.size(); ++level) {
                EXPECT_EQ(levels[level].of_child(), expected[level].of_child());
            }
        }
    }
}

// So that sweeps have few batches.
TEST(MakeHierarchy, NumbersAggregatesByColor) {
    const Box box({10, 8, 6, 4}, {10, 8, 6, 4});
    const std::vector<Aggregates> levels = box.hierarchy();
    const AggregatePattern pattern = make_aggregate_pattern(levels[0], box.pattern, nullptr);
    std::int64_t most = 0;  // neighbors, and itself
    for (std::uint32_t row = 0; row < pattern.rows(); ++row) {
        std::int64_t blocks = 0;
        for_each_in_row(pattern, row, [&](auto... /*of the block*/) { ++blocks; });
        most = std::max(most, blocks);
    }
    EXPECT_LE(static_cast<std::int64_t>(pattern.batches.size()) - 1, most);
}

// Two sheets closer together than the vertices of either.
TEST(MakeHierarchy, NeverJoinsWhatOnlyLiesSideBySide) {
    SimplexMesh<4> mesh = pent::test::kuhn_box<4>({6, 3, 1, 1}, {6, 3, 1, 1});
    const auto half = static_cast<std::uint32_t>(mesh.vertex_count());
    const Eigen::Index cells = mesh.cell_count();
    mesh.positions.conservativeResize(4, 2 * half);
    mesh.positions.rightCols(half) = mesh.positions.leftCols(half);
    mesh.positions.rightCols(half).row(3).array() += 1.01;
    mesh.cells.conservativeResize(5, 2 * cells);
    mesh.cells.rightCols(cells) = mesh.cells.leftCols(cells).array() + half;
    std::vector<std::uint32_t> own(2 * half);
    std::iota(own.begin(), own.end(), 0U);
    const DofMap dofs = number_dofs<4>(mesh.cells, std::vector<bool>(2 * half, false), {own, own});
    const BlockPattern pattern = make_pattern<4>(mesh.cells, dofs);
    const auto levels =
        make_hierarchy<4>(pattern, dofs.column_start(), at_dofs<4>(dofs, mesh.positions));
    for (std::size_t a = 0; a < number_of(levels[0]); ++a) {
        const auto members = levels[0].members(a);
        const bool is_first = dofs.vertex_of(members[0]) < half;
        for (const std::uint32_t dof : members) {
            EXPECT_EQ(dofs.vertex_of(dof) < half, is_first);
        }
    }
}

// A wall of columns side by side, 1 m apart: each dof is linked with those above, below and beside
// it.
template <int Dim>
std::vector<Aggregates> hierarchy_of_wall(std::uint32_t columns,
                                          std::uint32_t layers,
                                          double height_of_layer) {
    BlockPattern pattern;
    std::vector<std::uint32_t> column_start;
    Positions<Dim> places = Positions<Dim>::Zero(Dim, columns * layers);
    for (std::uint32_t row = 0; row < columns * layers; ++row) {
        pattern.row_start.push_back(static_cast<std::int64_t>(pattern.columns.size()));
        pattern.columns.push_back(row);
        if (row % layers + 1 < layers) {
            pattern.columns.push_back(row + 1);
        }
        if (row / layers + 1 < columns) {
            pattern.columns.push_back(row + layers);
        }
        if (row % layers == 0) {
            column_start.push_back(row);
        }
        places(0, row) = row / layers;
        places(Dim - 1, row) = height_of_layer * (row % layers);
    }
    pattern.row_start.push_back(static_cast<std::int64_t>(pattern.columns.size()));
    column_start.push_back(columns * layers);
    return make_hierarchy<Dim>(pattern, column_start, places);
}

template <int Dim>
std::vector<std::uint32_t> pieces_of_wall(std::uint32_t columns,
                                          std::uint32_t layers,
                                          double height_of_layer) {
    const Aggregates level = hierarchy_of_wall<Dim>(columns, layers, height_of_layer)[0];
    std::vector<std::uint32_t> first(number_of(level), columns * layers);
    std::vector<std::uint32_t> pieces;  // by their first dofs
    for (std::uint32_t row = 0; row < columns * layers; ++row) {
        std::uint32_t& of = first[level.of_child()[row]];
        of = std::min(of, row);
        pieces.push_back(of);
    }
    return pieces;
}

// Bricks of so many columns and layers.
std::vector<std::uint32_t> bricks(std::uint32_t columns,
                                  std::uint32_t layers,
                                  std::uint32_t wide,
                                  std::uint32_t high) {
    std::vector<std::uint32_t> pieces;
    for (std::uint32_t row = 0; row < columns * layers; ++row) {
        const std::uint32_t column = row / layers / wide * wide;
        const std::uint32_t layer = row % layers / high * high;
        pieces.push_back(column * layers + layer);
    }
    return pieces;
}

// By hand. Parts of columns of cubes are to be 1.9 w high where they are w wide, w^Dim being 29 /
// 1.9: 4.7 layers in 3D and 3.8 in 4D. A column of 12 has 2.5 or 3.2 of them, which is three, so
// that 7 or 8 columns have 29 dofs in each; one of 3 is less than a part, and ten columns have that
// many.
TEST(MakeHierarchy, BuildsAWallOfBricksWhoseSizesAreKnown) {
    EXPECT_EQ(pieces_of_wall<3>(21, 12, 1), bricks(21, 12, 7, 4));
    EXPECT_EQ(pieces_of_wall<4>(24, 12, 1), bricks(24, 12, 8, 4));
    EXPECT_EQ(pieces_of_wall<3>(40, 3, 1), bricks(40, 3, 10, 3));
    EXPECT_EQ(pieces_of_wall<4>(40, 3, 1), bricks(40, 3, 10, 3));
}

// Layers of a quarter count a quarter, but a column no less than the side of a cube of 29: 3.1 dofs
// in 3D and 2.3 in 4D, where twelve layers weigh 3.
TEST(MakeHierarchy, WeighsThinLayersByTheirHeight) {
    EXPECT_EQ(pieces_of_wall<3>(30, 12, 0.25), bricks(30, 12, 10, 12));
    EXPECT_EQ(pieces_of_wall<4>(30, 12, 0.25), bricks(30, 12, 10, 12));
    EXPECT_EQ(pieces_of_wall<3>(30, 12, 1e-3), bricks(30, 12, 10, 12));
    EXPECT_EQ(pieces_of_wall<4>(26, 12, 1e-3), bricks(26, 12, 13, 12));
}

// Bricks of 7 columns, three above one another.
TEST(MakeHierarchy, EndsAtTheCoarsestThatIsAllowed) {
    static_assert(kCoarsestAggregates == 3 * 8);
    EXPECT_EQ(hierarchy_of_wall<3>(7 * 8, 12, 1).size(), 1U);
    EXPECT_EQ(hierarchy_of_wall<3>(7 * 9, 12, 1).size(), 2U);
}

// However many vertices are in each: nearer to their own middle, that of all vertices, than to
// those beside it, but where a last round left something to move.
TEST(MakeHierarchy, GivesNearlyEveryAggregateToTheNearestMiddleBesideIt) {
    const Box box({20, 10, 8, 2}, {20, 10, 8, 2});
    const std::vector<Aggregates> levels = box.hierarchy();
    ASSERT_EQ(levels.size(), 3U);
    const auto middles_of = [&](std::size_t level) {
        Positions<4> middles = Positions<4>::Zero(4, levels[level].count());
        Eigen::VectorXd counts = Eigen::VectorXd::Zero(middles.cols());
        for (std::uint32_t dof = 0; dof < box.rest.cols(); ++dof) {
            std::uint32_t a = dof;
            for (std::size_t l = 0; l <= level; ++l) {
                a = levels[l].of_child()[a];
            }
            middles.col(a) += box.rest.col(dof);
            ++counts[a];
        }
        return Positions<4>(middles * counts.cwiseInverse().asDiagonal());
    };
    const Positions<4> own = middles_of(0);
    const Positions<4> next = middles_of(1);
    const Aggregates& parts = levels[0];
    const Aggregates& all = levels[1];
    std::set<std::uint32_t> misplaced;
    for (std::uint32_t row = 0; row < box.pattern.rows(); ++row) {
        for (std::int64_t k = box.pattern.row_start[row]; k < box.pattern.row_start[row + 1]; ++k) {
            const std::uint32_t column = box.pattern.columns[static_cast<std::size_t>(k)];
            for (const auto& [a, b] : {std::pair(row, column), std::pair(column, row)}) {
                const std::uint32_t part = parts.of_child()[a];
                const auto distance = [&](std::uint32_t of) {
                    return (own.col(part) - next.col(all.of_child()[of])).norm();
                };
                if (distance(parts.of_child()[b]) < 0.9 * distance(part)) {
                    misplaced.insert(part);
                }
            }
        }
    }
    EXPECT_LE(misplaced.size(), static_cast<std::size_t>(own.cols()) / 50);
}

TEST(MakeHierarchy, LeavesAloneWhatHasNoLinksAndEndsThere) {
    BlockPattern pattern;
    constexpr std::uint32_t kCount = 40;  // more than may be the coarsest
    for (std::uint32_t row = 0; row < kCount; ++row) {
        pattern.row_start.push_back(row);
        pattern.columns.push_back(row);
    }
    pattern.row_start.push_back(kCount);
    std::vector<std::uint32_t> columns(kCount + 1);
    std::iota(columns.begin(), columns.end(), 0U);
    const auto levels = make_hierarchy<3>(pattern, columns, Positions<3>::Random(3, kCount));
    ASSERT_EQ(levels.size(), 1U);
    EXPECT_EQ(levels[0].count(), static_cast<int>(kCount));
}

TEST(MakeHierarchy, IsOneLevelOfNothingWithoutDofs) {
    BlockPattern pattern;
    pattern.row_start = {0};
    const auto levels = make_hierarchy<4>(pattern, {0}, Positions<4>(4, 0));
    ASSERT_EQ(levels.size(), 1U);
    EXPECT_EQ(levels[0].count(), 0);
}

// A rank may have no dofs, or as few as one aggregate needs, where others have thousands.
TEST(MakeHierarchy, HasAsManyLevelsOnAllRanksAndFewAggregatesAtItsEnd) {
    const test::ElasticBox<4> box(pent::test::kuhn_box<4>({8, 6, 6, 6}, {1, 1, 1, 1}), {},
                                  ElementKind::Linear);
    const BlockMatrix<4, double> A(box.pattern);
    std::vector<std::uint32_t> owners;
    for (std::uint32_t dof = 0; dof < A.rows(); ++dof) {
        owners.push_back(dof < 40 ? 0 : dof < 1000 ? 1 : 2);
    }
    std::array<std::vector<int>, 4> counts;
    test::on_ranks(4, [&](const std::shared_ptr<const Ranks>& ranks) {
        const test::CutMatrix cut(A, owners, ranks);
        Positions<4> rest(4, A.rows());
        for (Eigen::Index column = 0; column < rest.cols(); ++column) {
            rest.col(column) = box.mesh.positions.col(
                box.dofs.vertex_of(cut.dofs[static_cast<std::size_t>(column)]));
        }
        std::size_t children = cut.column_start.size() - 1;
        for (const Aggregates& level :
             make_hierarchy<4>(cut.pattern, cut.column_start, rest, &cut.sharing)) {
            EXPECT_EQ(level.of_child().size(), children);
            children = number_of(level);
            counts[static_cast<std::size_t>(ranks->rank())].push_back(level.count());
        }
    });
    const auto all = [&](std::size_t level) {
        int sum = 0;
        for (const std::vector<int>& of_rank : counts) {
            sum += of_rank[level];
        }
        return sum;
    };
    for (const std::vector<int>& of_rank : counts) {
        ASSERT_EQ(of_rank.size(), counts[0].size());
    }
    EXPECT_EQ(counts[0][0], 1);
    EXPECT_EQ(counts[3][0], 0);
    EXPECT_GT(all(0), 2 * kCoarsestAggregates);
    EXPECT_LE(all(counts[0].size() - 1), kCoarsestAggregates);
}

}  // namespace
}  // namespace pent::simulator
