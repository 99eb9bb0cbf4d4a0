#include "patch_lanes.h"

#include <pent/dimensions.h>
#include <pent/parallel.h>

#include <algorithm>
#include <array>

namespace pent::contact {

template <int Dim>
void PatchLanes<Dim>::set(const PatchVertices& vertices, const PositionsView<Dim>& positions) {
    constexpr int kPatches = 64;
    using Point = Eigen::Matrix<float, Dim, 1>;
    const int corner_count = vertices.corner_count();
    stride_ = static_cast<std::size_t>(corner_count) * Dim * kLanes;
    corners_.resize(stride_ * vertices.size());
    patches_.resize(vertices.size());
    parallel_for(vertices.size(), kPatches, [&](std::size_t which) {
        const std::span<const std::uint32_t> own = vertices[which];
        std::array<Point, std::size_t{Dim} * kLanes> points;
        Patch& patch = patches_[which];
        patch.origin = positions.col(own[0]);
        patch.low.setZero();
        patch.high.setZero();
        for (std::size_t k = 0; k < own.size(); ++k) {
            points[k] = (positions.col(own[k]) - patch.origin).template cast<float>();
            patch.low = patch.low.cwiseMin(points[k]);
            patch.high = patch.high.cwiseMax(points[k]);
        }
        patch.extent = std::max(patch.high.maxCoeff(), -patch.low.minCoeff());
        float* const corners = corners_.data() + which * stride_;
        const std::uint8_t* const places = vertices.places(which);
        for (int corner = 0; corner < corner_count; ++corner) {
            for (int lane = 0; lane < kLanes; ++lane) {
                const Point& point = points[places[corner * kLanes + lane]];
                for (int axis = 0; axis < Dim; ++axis) {
                    corners[(corner * Dim + axis) * kLanes + lane] = point[axis];
                }
            }
        }
    });
}

#define PENT_INSTANTIATE(Dim) template class PatchLanes<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
