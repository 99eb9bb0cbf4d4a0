#include "halving.h"

#include <pent/parallel.h>

#include <algorithm>
#include <array>
#include <limits>

namespace pent::contact {

std::vector<CenteredBox> centered(std::span<const Box> boxes) {
    constexpr int kChunk = 4096;
    std::vector<CenteredBox> all(boxes.size());
    parallel_for(boxes.size(), kChunk, [&](std::size_t i) {
        for (int axis = 0; axis < 4; ++axis) {
            all[i].center[axis] = boxes[i].low[axis] + boxes[i].high[axis];
        }
        all[i].index = static_cast<std::uint32_t>(i);
    });
    return all;
}

void halve(std::span<CenteredBox> boxes, std::size_t in_first) {
    std::array<float, 4> low{};
    std::array<float, 4> high{};
    low.fill(std::numeric_limits<float>::infinity());
    high.fill(-std::numeric_limits<float>::infinity());
    for (const CenteredBox& box : boxes) {
        for (int axis = 0; axis < 4; ++axis) {
            low[axis] = std::min(low[axis], box.center[axis]);
            high[axis] = std::max(high[axis], box.center[axis]);
        }
    }
    int longest = 0;
    for (int axis = 1; axis < 4; ++axis) {
        if (high[axis] - low[axis] > high[longest] - low[longest]) {
            longest = axis;
        }
    }
    std::nth_element(boxes.begin(), boxes.begin() + static_cast<std::ptrdiff_t>(in_first),
                     boxes.end(), [longest](const CenteredBox& a, const CenteredBox& b) {
                         return a.center[longest] != b.center[longest]
                                    ? a.center[longest] < b.center[longest]
                                    : a.index < b.index;
                     });
}

}  // namespace pent::contact
