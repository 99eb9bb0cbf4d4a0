#pragma once

#include "near_lanes.h"
#include "patch_partition.h"

#include <pent/contact/surface.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace pent::contact {

/// The vertices of patches of simplices, and which of them are whose corners.
class PatchVertices {
public:
    PatchVertices() = default;

    /// @param partition  Of the simplices.
    template <int Count>
    PatchVertices(const Simplices<Count>& simplices, const PatchPartition& partition);

    /// The number of patches.
    [[nodiscard]] std::size_t size() const { return starts_.empty() ? 0 : starts_.size() - 1; }

    /// Where the vertices of each patch begin among those of all, and the number of all.
    [[nodiscard]] const std::vector<std::size_t>& starts() const { return starts_; }

    /// The vertices of all patches, one patch after the other.
    [[nodiscard]] const std::vector<std::uint32_t>& of_all() const { return vertices_; }

    /// The vertices of a patch, ascending, each once.
    [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t patch) const {
        return std::span(vertices_).subspan(starts_[patch], starts_[patch + 1] - starts_[patch]);
    }

    /// Simplices of a patch.
    [[nodiscard]] int simplex_count(std::size_t patch) const { return simplex_counts_[patch]; }
    /// Corners of a simplex.
    [[nodiscard]] int corner_count() const { return corner_count_; }

    /// The corners of the simplices of a patch, padded to kLanes by the first one: [corner][lane],
    /// numbers of vertices of the scene.
    [[nodiscard]] const std::int32_t* corners(std::size_t patch) const {
        return corners_.data() + stride() * patch;
    }

    /// The same as places among the vertices of the patch.
    [[nodiscard]] const std::uint8_t* places(std::size_t patch) const {
        return places_.data() + stride() * patch;
    }

    [[nodiscard]] std::int64_t bytes() const;

private:
    [[nodiscard]] std::size_t stride() const {
        return static_cast<std::size_t>(corner_count_) * kLanes;
    }

    int corner_count_ = 0;
    std::vector<std::size_t> starts_;
    std::vector<std::uint32_t> vertices_;
    std::vector<std::int32_t> corners_;
    std::vector<std::uint8_t> places_;
    std::vector<std::uint8_t> simplex_counts_;
};

}  // namespace pent::contact
