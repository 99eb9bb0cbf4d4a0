#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace pent::simulator {

/// Chunks of work by color: those of one color touch no common vertex and may run concurrently.
///
/// Colors run one after the other, so that contributions to a vertex are added in the same order
/// for any number of threads.
struct Coloring {
    std::vector<std::vector<int>> colors;  ///< Chunk numbers of each color, increasing.
};

/// Greedy coloring of chunks 0..chunks-1.
///
/// @param touched  Calls its second argument with every vertex (below `vertices`) chunk i touches.
[[nodiscard]] Coloring color_chunks(
    int chunks,
    std::int64_t vertices,
    const std::function<void(int, const std::function<void(std::uint32_t)>&)>& touched);

}  // namespace pent::simulator
