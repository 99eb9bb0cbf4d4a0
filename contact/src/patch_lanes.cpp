#include "patch_lanes.h"

#include <pent/dimensions.h>
#include <pent/parallel.h>

#include <algorithm>
#include <limits>

namespace pent::contact {

template <int Dim>
template <int Count>
void PatchLanes<Dim>::set(const Simplices<Count>& simplices,
                          const PatchPartition& partition,
                          const PositionsView<Dim>& positions) {
    constexpr int kPatches = 64;
    stride_ = std::size_t{Count} * Dim * kLanes;
    corners_.resize(stride_ * partition.size());
    vertices_.resize(stride_ / Dim * partition.size());
    patches_.resize(partition.size());
    parallel_for(partition.size(), kPatches, [&](std::size_t which) {
        using Corner = Eigen::Matrix<float, Dim, 1>;
        const std::span<const std::uint32_t> members = partition[which];
        Patch& patch = patches_[which];
        patch.origin = positions.col(simplices(0, members[0]));
        patch.count = static_cast<int>(members.size());
        patch.low.setConstant(std::numeric_limits<float>::infinity());
        patch.high = -patch.low;
        float* const corners = corners_.data() + which * stride_;
        std::int32_t* const vertices = vertices_.data() + which * stride_ / Dim;
        for (int lane = 0; lane < kLanes; ++lane) {
            const std::uint32_t i =
                members[lane < patch.count ? static_cast<std::size_t>(lane) : 0];
            for (int corner = 0; corner < Count; ++corner) {
                const std::uint32_t vertex = simplices(corner, i);
                vertices[corner * kLanes + lane] = static_cast<std::int32_t>(vertex);
                const Corner at = (positions.col(vertex) - patch.origin).template cast<float>();
                patch.low = patch.low.cwiseMin(at);
                patch.high = patch.high.cwiseMax(at);
                for (int axis = 0; axis < Dim; ++axis) {
                    corners[(corner * Dim + axis) * kLanes + lane] = at[axis];
                }
            }
        }
        patch.extent = std::max(patch.high.maxCoeff(), -patch.low.minCoeff());
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
