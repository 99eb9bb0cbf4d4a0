#pragma once

#include <pent/contact/box.h>

#include <cstdint>
#include <span>
#include <vector>

namespace pent::contact {

/// Simplices of a surface divided into patches of neighbors, as few of them as there can be of at
/// most kLanes; sizes differ by one at most. Patches that follow each other are neighbors, too.
class PatchPartition {
public:
    PatchPartition() = default;

    /// Divides by halving along the longest side, as a BoxTree does. Without boxes there are no
    /// patches. Parallel.
    explicit PatchPartition(std::span<const Box> boxes);

    /// The number of patches.
    [[nodiscard]] std::size_t size() const { return begin_.empty() ? 0 : begin_.size() - 1; }

    /// Which simplices a patch has.
    [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t patch) const {
        return std::span(simplices_).subspan(begin_[patch], begin_[patch + 1] - begin_[patch]);
    }

    [[nodiscard]] std::int64_t bytes() const {
        return static_cast<std::int64_t>((simplices_.size() + begin_.size())
                                         * sizeof(std::uint32_t));
    }

private:
    std::vector<std::uint32_t> simplices_;  // by patches
    std::vector<std::uint32_t> begin_;      // of each patch, and one more
};

}  // namespace pent::contact
