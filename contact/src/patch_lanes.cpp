#include "patch_lanes.h"

#include <pent/dimensions.h>
#include <pent/parallel.h>
#include <pent/simd.h>

#include <algorithm>
#include <array>

namespace pent::contact {

template <int Dim>
void PatchLanes<Dim>::set(const PatchVertices& vertices, const PositionsView<Dim>& positions) {
    constexpr int kPatches = 64;
    constexpr int kFour = 4;
    using Four = Pack<float, kFour>;
    const int corner_count = vertices.corner_count();
    stride_ = static_cast<std::size_t>(corner_count) * Dim * kLanes;
    corners_.resize(stride_ * vertices.size());
    patches_.resize(vertices.size());
    parallel_for(vertices.size(), kPatches, [&](std::size_t which) {
        const std::span<const std::uint32_t> own = vertices[which];
        std::array<Four, std::size_t{Dim} * kLanes> points;  // with zeros for axes there are not
        Patch& patch = patches_[which];
        patch.origin = positions.col(own[0]);
        Four low(0.0F);
        Four high(0.0F);
        for (std::size_t k = 0; k < own.size(); ++k) {
            Eigen::Vector4f point = Eigen::Vector4f::Zero();
            point.template head<Dim>() =
                (positions.col(own[k]) - patch.origin).template cast<float>();
            points[k] = Four::load(point.data());
            low = min(low, points[k]);
            high = max(high, points[k]);
        }
        low.store(patch.low.data());
        high.store(patch.high.data());
        patch.extent = std::max(*std::max_element(patch.high.begin(), patch.high.end()),
                                -*std::min_element(patch.low.begin(), patch.low.end()));
        float* to = corners_.data() + which * stride_;
        const std::uint8_t* places = vertices.places(which);
        for (int corner = 0; corner < corner_count; ++corner) {
            for (int lane = 0; lane < kLanes; lane += kFour) {
                std::array<Four, kFour> four{points[places[0]], points[places[1]],
                                             points[places[2]], points[places[3]]};
                transpose<kFour>(four.data());
                for (std::size_t axis = 0; axis < Dim; ++axis) {
                    four[axis].store(to + axis * kLanes + lane);
                }
                places += kFour;
            }
            to += std::size_t{Dim} * kLanes;
        }
    });
}

#define PENT_INSTANTIATE(Dim) template class PatchLanes<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
