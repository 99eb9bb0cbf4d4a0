#include "patch_partition.h"

#include "near_lanes.h"

#include <pent/contact/box_tree.h>

namespace pent::contact {

PatchPartition::PatchPartition(std::span<const Box> boxes) {
    if (boxes.empty()) {
        return;
    }
    const BoxTree tree(boxes);
    std::vector<BoxTree::Range> ranges{tree.root()};
    // The first range is never smaller than another.
    while (ranges[0].count > kLanes) {
        std::vector<BoxTree::Range> halves;
        for (const BoxTree::Range& range : ranges) {
            halves.push_back(range.left());
            halves.push_back(range.right());
        }
        ranges.swap(halves);
    }
    begin_.push_back(0);
    for (const BoxTree::Range& range : ranges) {
        for (std::uint32_t place = range.begin; place < range.begin + range.count; ++place) {
            simplices_.push_back(tree.leaf(place));
        }
        begin_.push_back(static_cast<std::uint32_t>(simplices_.size()));
    }
}

}  // namespace pent::contact
