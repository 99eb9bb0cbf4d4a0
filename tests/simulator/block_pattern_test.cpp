#include "linear/block_pattern.h"

#include "elastic_box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

namespace pent::simulator {
namespace {

using test::ElasticBox;

TEST(BlockPattern, HoldsEveryPairOfFreeVerticesOfACellOnceAndInOrder) {
    ElasticBox<4> box({.lame = {.lambda = 1, .mu = 1}}, {5, 6});
    const BlockPattern& pattern = box.pattern;
    EXPECT_EQ(pattern.rows(), box.mesh.vertex_count() - 2);
    for (std::int64_t row = 0; row < pattern.rows(); ++row) {
        const auto r = static_cast<std::size_t>(row);
        EXPECT_EQ(pattern.columns[static_cast<std::size_t>(pattern.row_start[r])], row);
        for (std::int64_t k = pattern.row_start[r] + 1; k < pattern.row_start[r + 1]; ++k) {
            const auto i = static_cast<std::size_t>(k);
            EXPECT_GT(pattern.columns[i], pattern.columns[i - 1]);
        }
    }
    for (Eigen::Index cell = 0; cell < box.mesh.cell_count(); ++cell) {
        for (int a = 0; a <= 4; ++a) {
            for (int b = 0; b <= 4; ++b) {
                const auto row = box.dofs.index_of(box.mesh.cells(a, cell));
                const auto column = box.dofs.index_of(box.mesh.cells(b, cell));
                if (row <= column && column < box.dofs.count()) {
                    const auto at = static_cast<std::size_t>(pattern.find(row, column));
                    EXPECT_EQ(pattern.columns[at], column);
                    EXPECT_LT(at, static_cast<std::size_t>(pattern.row_start[row + 1]));
                }
            }
        }
    }
}

// Rows and columns that chunks of one color touch do not overlap, so that products may run at once.
TEST(BlockPattern, ChunksOfOneColorTouchDifferentRows) {
    const SimplexMesh<4> mesh = pent::test::kuhn_box<4>({40, 4, 4, 4}, {10, 1, 1, 1});
    std::vector<std::uint32_t> columns(static_cast<std::size_t>(mesh.vertex_count()));
    std::iota(columns.begin(), columns.end(), 0U);
    const DofMap dofs =
        number_dofs<4>(mesh.cells, std::vector<bool>(columns.size(), false), {columns, columns});
    const BlockPattern pattern = make_pattern<4>(mesh.cells, dofs);
    ASSERT_GT(pattern.chunks, 4);
    std::size_t seen = 0;
    for (const std::vector<int>& color : pattern.coloring.colors) {
        std::set<std::uint32_t> touched;
        for (const int chunk : color) {
            ++seen;
            std::set<std::uint32_t> own;
            const std::int64_t first = chunk * BlockPattern::kChunkRows;
            const std::int64_t last = std::min(pattern.rows(), first + BlockPattern::kChunkRows);
            for (std::int64_t row = first; row < last; ++row) {
                const auto r = static_cast<std::size_t>(row);
                for (std::int64_t k = pattern.row_start[r]; k < pattern.row_start[r + 1]; ++k) {
                    own.insert(pattern.columns[static_cast<std::size_t>(k)]);
                }
            }
            for (const std::uint32_t row : own) {
                EXPECT_TRUE(touched.insert(row).second) << row;
            }
        }
    }
    EXPECT_EQ(seen, static_cast<std::size_t>(pattern.chunks));
}

// Elements with different numbers of corners, of two lists at once, against every pair.
TEST(BlockPattern, OfListsHasThePairsOfTheirElements) {
    const ElasticBox<3> box({.lame = {.lambda = 1, .mu = 1}}, {1});
    const CornerLists two{.start = {0, 2, 5}, .corners = {0, 7, 2, 1, 5}};
    const CornerLists one{.start = {0, 3}, .corners = {3, 4, 7}};
    const BlockPattern pattern = make_pattern({&two, &one}, box.dofs);
    std::set<std::pair<std::uint32_t, std::uint32_t>> expected;
    for (const auto& element : {std::vector<std::uint32_t>{0, 7}, {2, 1, 5}, {3, 4, 7}}) {
        for (const std::uint32_t a : element) {
            for (const std::uint32_t b : element) {
                const std::uint32_t row = box.dofs.index_of(a);
                const std::uint32_t column = box.dofs.index_of(b);
                if (row <= column && column < box.dofs.count()) {
                    expected.emplace(row, column);
                }
            }
        }
    }
    for (std::uint32_t row = 0; row < box.dofs.count(); ++row) {
        expected.emplace(row, row);  // a dof without an element, too
    }
    std::set<std::pair<std::uint32_t, std::uint32_t>> found;
    for (std::uint32_t row = 0; row < pattern.rows(); ++row) {
        for (std::int64_t k = pattern.row_start[row]; k < pattern.row_start[row + 1]; ++k) {
            found.emplace(row, pattern.columns[static_cast<std::size_t>(k)]);
        }
    }
    EXPECT_EQ(found, expected);
    EXPECT_EQ(pattern.blocks(), static_cast<std::int64_t>(expected.size()));
    // Vertex 1, which is held, shares an element with 2 and 5.
    for (const std::uint32_t vertex : box.dofs.vertices()) {
        EXPECT_EQ(pattern.is_cut[box.dofs.dof_of(vertex)], vertex == 2 || vertex == 5) << vertex;
    }
}

// Rows that are coupled with nothing.
BlockPattern diagonal_pattern(std::int64_t rows) {
    BlockPattern pattern;
    pattern.row_start.resize(static_cast<std::size_t>(rows) + 1);
    std::iota(pattern.row_start.begin(), pattern.row_start.end(), 0);
    pattern.columns.resize(static_cast<std::size_t>(rows));
    std::iota(pattern.columns.begin(), pattern.columns.end(), 0U);
    return pattern;
}

TEST(BlockPattern, HasChunksForItsLastRowAndNoneBehindIt) {
    constexpr std::int64_t kChunk = BlockPattern::kChunkRows;
    for (const std::int64_t rows :
         {std::int64_t{0}, std::int64_t{1}, kChunk - 1, kChunk, kChunk + 1, 2 * kChunk}) {
        BlockPattern pattern = diagonal_pattern(rows);
        color_rows(pattern, rows);
        EXPECT_GE(pattern.chunks * kChunk, rows);
        EXPECT_LT((pattern.chunks - 1) * kChunk, rows);
        std::size_t colored = 0;
        for (const std::vector<int>& color : pattern.coloring.colors) {
            colored += color.size();
        }
        EXPECT_EQ(colored, static_cast<std::size_t>(pattern.chunks));
    }
}

// Rows 0 to 2 and columns up to 8; by the second part, too.
TEST(BlockPattern, HasTheColumnsWithoutRowsOnceEachAndIncreasing) {
    BlockPattern pattern;
    pattern.row_start = {0, 3, 6, 7};
    pattern.columns = {0, 2, 7, 1, 4, 7, 2};
    BlockPattern coupling;
    coupling.row_start = {0, 2, 3, 5};
    coupling.columns = {0, 8, 1, 2, 4};
    EXPECT_EQ(ghost_columns(pattern), (std::vector<std::uint32_t>{4, 7}));
    EXPECT_EQ(ghost_columns(pattern, &coupling), (std::vector<std::uint32_t>{4, 7, 8}));
    EXPECT_TRUE(ghost_columns(diagonal_pattern(3)).empty());
}

}  // namespace
}  // namespace pent::simulator
