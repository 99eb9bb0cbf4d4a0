#pragma once

#include <pent/contact/box.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace pent::contact {

/// A box of a list, to be put beside its neighbors.
struct CenteredBox {
    float center[4];          // NOLINT(modernize-avoid-c-arrays): twice, m
    std::uint32_t index = 0;  ///< In the list.
};

/// Parallel.
[[nodiscard]] std::vector<CenteredBox> centered(std::span<const Box> boxes);

/// Puts the first half in front, along the longest side of the centers.
///
/// @param in_first  How many boxes that has.
void halve(std::span<CenteredBox> boxes, std::size_t in_first);

}  // namespace pent::contact
