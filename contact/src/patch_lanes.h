#pragma once

#include "near_lanes.h"
#include "patch_partition.h"

#include <pent/contact/surface.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pent::contact {

/// The corners of the simplices of all patches of a surface, side by side, for the kernels of
/// near_lanes.h.
template <int Dim>
class PatchLanes {
public:
    /// Parallel.
    ///
    /// @param partition  Of the simplices.
    template <int Count>
    void set(const Simplices<Count>& simplices,
             const PatchPartition& partition,
             const PositionsView<Dim>& positions);

    [[nodiscard]] LanesView operator[](std::size_t patch) const {
        const Patch& of = patches_[patch];
        return {.corners = corners_.data() + patch * stride_,
                .vertices = vertices_.data() + patch * stride_ / Dim,
                .origin = of.origin.data(),
                .low = of.low.data(),
                .high = of.high.data(),
                .extent = of.extent,
                .count = of.count};
    }

    [[nodiscard]] std::int64_t bytes() const {
        return static_cast<std::int64_t>(corners_.size() * sizeof(float)
                                         + vertices_.size() * sizeof(std::int32_t)
                                         + patches_.size() * sizeof(Patch));
    }

private:
    struct Patch {
        Vector<Dim> origin;
        Eigen::Matrix<float, Dim, 1> low;
        Eigen::Matrix<float, Dim, 1> high;
        float extent = 0;
        int count = 0;
    };

    std::size_t stride_ = 0;  // floats of a patch
    std::vector<float> corners_;
    std::vector<std::int32_t> vertices_;
    std::vector<Patch> patches_;
};

}  // namespace pent::contact
