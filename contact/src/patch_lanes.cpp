#include "patch_lanes.h"

#include <pent/dimensions.h>
#include <pent/parallel.h>

#include <algorithm>
#include <cmath>

namespace pent::contact {

template <int Dim>
template <int Count>
void PatchLanes<Dim>::set(const Simplices<Count>& simplices,
                          const PatchPartition& partition,
                          const PositionsView<Dim>& positions) {
    constexpr int kPatches = 64;
    stride_ = std::size_t{Count} * Dim * kLanes;
    corners_.resize(stride_ * partition.size());
    patches_.resize(partition.size());
    parallel_for(partition.size(), kPatches, [&](std::size_t which) {
        const std::span<const std::uint32_t> members = partition[which];
        Patch& patch = patches_[which];
        patch.origin = positions.col(simplices(0, members[0]));
        float extent = 0;
        patch.count = static_cast<int>(members.size());
        float* corners = corners_.data() + which * stride_;
        for (int lane = 0; lane < patch.count; ++lane) {
            const std::uint32_t i = members[static_cast<std::size_t>(lane)];
            for (int corner = 0; corner < Count; ++corner) {
                const Vector<Dim> at = positions.col(simplices(corner, i)) - patch.origin;
                for (int axis = 0; axis < Dim; ++axis) {
                    const auto x = static_cast<float>(at[axis]);
                    corners[(corner * Dim + axis) * kLanes + lane] = x;
                    extent = std::max(extent, std::abs(x));
                }
            }
        }
        patch.extent = extent;
    });
}

#define PENT_INSTANTIATE_OF(Dim, Count)                                                \
    template void PatchLanes<Dim>::set(const Simplices<Count>&, const PatchPartition&, \
                                       const PositionsView<Dim>&);
#define PENT_INSTANTIATE(Dim) template class PatchLanes<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE_OF, 1)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE_OF, 2)
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE_OF, 3)
PENT_INSTANTIATE_OF(4, 4)
#undef PENT_INSTANTIATE
#undef PENT_INSTANTIATE_OF

}  // namespace pent::contact
