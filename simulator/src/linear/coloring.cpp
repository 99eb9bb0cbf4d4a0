#include "linear/coloring.h"

#include <bit>

namespace pent::simulator {

Coloring color_chunks(
    int chunks,
    std::int64_t vertices,
    const std::function<void(int, const std::function<void(std::uint32_t)>&)>& touched) {
    constexpr int kColors = 64;  // bits of a set of colors
    std::vector<std::uint64_t> used(static_cast<std::size_t>(vertices), 0);  // at each vertex
    Coloring coloring;
    std::vector<int> alone;  // chunks that found no color left: each gets one of its own
    for (int chunk = 0; chunk < chunks; ++chunk) {
        std::uint64_t taken = 0;
        touched(chunk, [&](std::uint32_t vertex) { taken |= used[vertex]; });
        const int color = std::countr_one(taken);
        if (color == kColors) {
            alone.push_back(chunk);
            continue;
        }
        touched(chunk, [&](std::uint32_t vertex) { used[vertex] |= std::uint64_t{1} << color; });
        if (color == static_cast<int>(coloring.colors.size())) {
            coloring.colors.emplace_back();
        }
        coloring.colors[static_cast<std::size_t>(color)].push_back(chunk);
    }
    for (const int chunk : alone) {
        coloring.colors.push_back({chunk});
    }
    return coloring;
}

}  // namespace pent::simulator
