#pragma once

#include "near_lanes.h"
#include "patch_vertices.h"

#include <pent/contact/stencil.h>
#include <pent/contact/surface.h>

#include <array>
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
    /// @param positions  Of all vertices of the scene.
    void set(const PatchVertices& vertices, const PositionsView<Dim>& positions);

    /// @param vertices  That the positions were set of.
    [[nodiscard]] LanesView of(std::size_t patch, const PatchVertices& vertices) const {
        const Patch& of = patches_[patch];
        return {.corners = corners_.data() + patch * stride_,
                .vertices = vertices.corners(patch),
                .origin = of.origin.data(),
                .low = of.low.data(),
                .high = of.high.data(),
                .extent = of.extent,
                .count = vertices.simplex_count(patch)};
    }

    [[nodiscard]] std::int64_t bytes() const {
        return static_cast<std::int64_t>(corners_.size() * sizeof(float)
                                         + patches_.size() * sizeof(Patch));
    }

private:
    struct Patch {
        Vector<Dim> origin;
        std::array<float, 4> low{};  // 0 for axes that there are not
        std::array<float, 4> high{};
        float extent = 0;
    };

    std::size_t stride_ = 0;  // floats of a patch
    std::vector<float> corners_;
    std::vector<Patch> patches_;
};

}  // namespace pent::contact
