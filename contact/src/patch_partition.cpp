#include "patch_partition.h"

#include "halving.h"
#include "near_lanes.h"

namespace pent::contact {

PatchPartition::PatchPartition(std::span<const Box> boxes) {
    if (boxes.empty()) {
        return;
    }
    const std::size_t patches = (boxes.size() + kLanes - 1) / kLanes;
    for (std::size_t patch = 0; patch <= patches; ++patch) {
        begin_.push_back(static_cast<std::uint32_t>(patch * boxes.size() / patches));
    }
    simplices_ = order_by_halving(boxes, begin_);
}

}  // namespace pent::contact
