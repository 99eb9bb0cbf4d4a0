#include "halving.h"

#include <pent/parallel.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace pent::contact {

namespace {

// Fewer boxes are the work of one thread.
constexpr std::size_t kSerial = 4096;

struct Item {
    float center[4];  // NOLINT(modernize-avoid-c-arrays): twice
    std::uint32_t index = 0;
};

int longest_side(std::span<const Item> items) {
    std::array<float, 4> low{};
    std::array<float, 4> high{};
    low.fill(std::numeric_limits<float>::infinity());
    high.fill(-std::numeric_limits<float>::infinity());
    for (const Item& item : items) {
        for (int axis = 0; axis < 4; ++axis) {
            low[axis] = std::min(low[axis], item.center[axis]);
            high[axis] = std::max(high[axis], item.center[axis]);
        }
    }
    int longest = 0;
    for (int axis = 1; axis < 4; ++axis) {
        if (high[axis] - low[axis] > high[longest] - low[longest]) {
            longest = axis;
        }
    }
    return longest;
}

// Orders the items of some groups, which are a stretch of all items.
void halve(std::span<Item> items, std::span<const std::uint32_t> begin) {
    if (begin.size() < 3) {
        return;
    }
    const std::size_t in_left = begin.size() / 2;
    const std::span<Item> own = items.subspan(begin.front(), begin.back() - begin.front());
    const int axis = longest_side(own);
    std::nth_element(own.begin(),
                     own.begin() + static_cast<std::ptrdiff_t>(begin[in_left] - begin.front()),
                     own.end(), [axis](const Item& a, const Item& b) {
                         return a.center[axis] != b.center[axis] ? a.center[axis] < b.center[axis]
                                                                 : a.index < b.index;
                     });
    const auto halve_left = [&] { halve(items, begin.first(in_left + 1)); };
    const auto halve_right = [&] { halve(items, begin.subspan(in_left)); };
    if (own.size() < kSerial) {
        halve_left();
        halve_right();
    } else {
        parallel_invoke(halve_left, halve_right);
    }
}

}  // namespace

std::vector<std::uint32_t> order_by_halving(std::span<const Box> boxes,
                                            std::span<const std::uint32_t> begin) {
    std::vector<Item> items(boxes.size());
    parallel_for(boxes.size(), static_cast<int>(kSerial), [&](std::size_t i) {
        for (int axis = 0; axis < 4; ++axis) {
            items[i].center[axis] = boxes[i].low[axis] + boxes[i].high[axis];
        }
        items[i].index = static_cast<std::uint32_t>(i);
    });
    halve(items, begin);
    std::vector<std::uint32_t> order(boxes.size());
    std::transform(items.begin(), items.end(), order.begin(),
                   [](const Item& item) { return item.index; });
    return order;
}

}  // namespace pent::contact
