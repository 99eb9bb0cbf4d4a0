#include "linear/dof_map.h"

#include "support/kuhn_box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace pent::simulator {
namespace {

TEST(DofMap, KeepsColumnsTogetherInTheOrderOfTheirLayers) {
    const SimplexMesh<4> mesh = pent::test::kuhn_box<4>({3, 2, 2, 4}, {1, 1, 1, 1});
    const std::uint32_t base = 4 * 3 * 3;
    std::vector<std::uint32_t> columns;
    std::vector<std::uint32_t> layers;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        columns.push_back(v % base);
        layers.push_back(v / base);
    }
    std::vector<bool> is_held(columns.size(), false);
    is_held[base] = true;  // one vertex of column 0
    const DofMap dofs = number_dofs<4>(mesh.cells, is_held, {columns, layers});
    EXPECT_EQ(dofs.count(), columns.size() - 1);
    EXPECT_EQ(dofs.column_start().size(), base + 1);
    for (std::size_t c = 0; c + 1 < dofs.column_start().size(); ++c) {
        for (std::uint32_t u = dofs.column_start()[c] + 1; u < dofs.column_start()[c + 1]; ++u) {
            const std::uint32_t above = dofs.vertex_of(u);
            const std::uint32_t below = dofs.vertex_of(u - 1);
            EXPECT_EQ(columns[above], columns[below]);
            EXPECT_GT(layers[above], layers[below]);
        }
    }
    EXPECT_FALSE(dofs.has_dof(base));
}

TEST(DofMap, NumbersEveryFreeVertexOnce) {
    const SimplexMesh<3> mesh = pent::test::kuhn_box<3>({3, 3, 3}, {1, 1, 1});
    std::vector<std::uint32_t> own(static_cast<std::size_t>(mesh.vertex_count()));
    std::iota(own.begin(), own.end(), 0U);
    const DofMap dofs =
        number_dofs<3>(mesh.cells, std::vector<bool>(own.size(), false), {own, own});
    std::vector<std::uint32_t> sorted = dofs.vertices();
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(sorted, own);
    for (std::uint32_t u = 0; u < own.size(); ++u) {
        EXPECT_EQ(dofs.dof_of(dofs.vertex_of(u)), u);
    }
}

// A bar of 40 cubes of cross-section 2 x 2 vertices, vertices shuffled: neighbors in a cell end up
// within a few cross-sections of one another.
TEST(DofMap, KeepsNeighborsCloseInAShuffledBar) {
    SimplexMesh<3> mesh = pent::test::kuhn_box<3>({40, 1, 1}, {40, 1, 1});
    std::vector<std::uint32_t> shuffled(static_cast<std::size_t>(mesh.vertex_count()));
    std::iota(shuffled.begin(), shuffled.end(), 0U);
    const std::vector<std::uint32_t> own = shuffled;
    std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(4));
    mesh.cells = mesh.cells.unaryExpr([&](std::uint32_t v) { return shuffled[v]; });
    const DofMap dofs =
        number_dofs<3>(mesh.cells, std::vector<bool>(own.size(), false), {own, own});
    std::uint32_t widest = 0;
    for (const auto cell : mesh.cells.colwise()) {
        for (const std::uint32_t a : cell) {
            for (const std::uint32_t b : cell) {
                const std::uint32_t i = dofs.dof_of(a);
                const std::uint32_t j = dofs.dof_of(b);
                widest = std::max(widest, i > j ? i - j : j - i);
            }
        }
    }
    EXPECT_LE(widest, 12U);
}

// Cells, columns and what is held drawn at random: what hangs together with what does not matter.
TEST(DofMap, NumbersEveryFreeVertexOnceInColumnsThatAreNotEmptyWhateverIsHeld) {
    std::mt19937 random(7);
    const auto below = [&](std::uint32_t most) {
        return std::uniform_int_distribution<std::uint32_t>(0, most - 1)(random);
    };
    for (int round = 0; round < 300; ++round) {
        const std::uint32_t vertices = 8 + below(20);
        const std::uint32_t count = 1 + below(vertices);
        Columns columns;
        std::vector<bool> is_held;
        for (std::uint32_t v = 0; v < vertices; ++v) {
            columns.columns.push_back(v < count ? v : below(count));
            columns.layers.push_back(below(5));
            is_held.push_back(below(2) == 0);
        }
        Simplices<4> cells(4, 1 + below(8));
        cells = cells.unaryExpr([&](std::uint32_t) { return below(vertices); });
        const DofMap dofs = number_dofs<3>(cells, is_held, columns);
        std::vector<std::uint32_t> expected;
        for (std::uint32_t v = 0; v < vertices; ++v) {
            EXPECT_EQ(dofs.has_dof(v), !is_held[v]);
            if (!is_held[v]) {
                expected.push_back(v);
            }
        }
        std::vector<std::uint32_t> found = dofs.vertices();
        std::sort(found.begin(), found.end());
        ASSERT_EQ(found, expected);
        const std::vector<std::uint32_t>& start = dofs.column_start();
        EXPECT_EQ(start.front(), 0U);
        EXPECT_EQ(start.back(), dofs.count());
        std::vector<bool> is_seen(count, false);
        for (std::size_t c = 0; c + 1 < start.size(); ++c) {
            ASSERT_LT(start[c], start[c + 1]);
            const std::uint32_t column = columns.columns[dofs.vertex_of(start[c])];
            EXPECT_FALSE(is_seen[column]);
            is_seen[column] = true;
            for (std::uint32_t dof = start[c] + 1; dof < start[c + 1]; ++dof) {
                EXPECT_EQ(columns.columns[dofs.vertex_of(dof)], column);
                EXPECT_GE(columns.layers[dofs.vertex_of(dof)],
                          columns.layers[dofs.vertex_of(dof - 1)]);
            }
        }
    }
}

}  // namespace
}  // namespace pent::simulator
