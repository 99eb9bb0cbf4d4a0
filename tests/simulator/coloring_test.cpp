#include "linear/coloring.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace pent::simulator {
namespace {

void expect_valid(const std::vector<std::vector<std::uint32_t>>& chunks, std::int64_t vertices) {
    const Coloring coloring =
        color_chunks(static_cast<int>(chunks.size()), vertices, [&](int i, const auto& touch) {
            for (const std::uint32_t vertex : chunks[static_cast<std::size_t>(i)]) {
                touch(vertex);
            }
        });
    std::set<int> seen;
    for (const std::vector<int>& color : coloring.colors) {
        std::set<std::uint32_t> touched;
        for (const int chunk : color) {
            EXPECT_TRUE(seen.insert(chunk).second);
            const auto& list = chunks[static_cast<std::size_t>(chunk)];
            for (const std::uint32_t vertex : std::set<std::uint32_t>(list.begin(), list.end())) {
                EXPECT_TRUE(touched.insert(vertex).second);
            }
        }
    }
    EXPECT_EQ(seen.size(), chunks.size());
}

TEST(ColorChunks, NeverPutsChunksThatShareAVertexInOneColor) {
    std::mt19937 random(1);
    std::uniform_int_distribution<std::uint32_t> vertex(0, 99);
    std::vector<std::vector<std::uint32_t>> chunks(50);
    for (auto& chunk : chunks) {
        for (int i = 0; i < 6; ++i) {
            chunk.push_back(vertex(random));
        }
    }
    expect_valid(chunks, 100);
}

TEST(ColorChunks, WorksWhenAllOfMoreThan64ChunksShareAVertex) {
    const std::vector<std::vector<std::uint32_t>> chunks(70, {0});
    expect_valid(chunks, 1);
}

TEST(ColorChunks, GivesOneColorToChunksApart) {
    const Coloring coloring =
        color_chunks(3, 3, [](int i, const auto& touch) { touch(static_cast<std::uint32_t>(i)); });
    EXPECT_EQ(coloring.colors.size(), 1U);
}

}  // namespace
}  // namespace pent::simulator
