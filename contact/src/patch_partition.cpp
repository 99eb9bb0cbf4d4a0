#include "patch_partition.h"

#include "halving.h"
#include "near_lanes.h"

#include <pent/parallel.h>

namespace pent::contact {

namespace {

// Ranges of fewer patches are halved by one thread.
constexpr std::size_t kSerial = 256;

// Puts boxes into the order of patches: of `count`, from the first one on.
void sort(std::span<CenteredBox> boxes,
          const std::vector<std::uint32_t>& begin,
          std::size_t first,
          std::size_t count) {
    if (count < 2) {
        return;
    }
    const std::size_t in_left = (count + 1) / 2;
    const std::size_t middle = first + in_left;
    halve(boxes.subspan(begin[first], begin[first + count] - begin[first]),
          begin[middle] - begin[first]);
    const auto sort_left = [&] { sort(boxes, begin, first, in_left); };
    const auto sort_right = [&] { sort(boxes, begin, middle, count - in_left); };
    if (count < kSerial) {
        sort_left();
        sort_right();
    } else {
        parallel_invoke(sort_left, sort_right);
    }
}

}  // namespace

PatchPartition::PatchPartition(std::span<const Box> boxes) {
    if (boxes.empty()) {
        return;
    }
    const std::size_t patches = (boxes.size() + kLanes - 1) / kLanes;
    for (std::size_t patch = 0; patch <= patches; ++patch) {
        begin_.push_back(static_cast<std::uint32_t>(patch * boxes.size() / patches));
    }
    std::vector<CenteredBox> sorted = centered(boxes);
    sort(sorted, begin_, 0, patches);
    for (const CenteredBox& box : sorted) {
        simplices_.push_back(box.index);
    }
}

}  // namespace pent::contact
