#pragma once

#include <pent/contact/box.h>

#include <cstdint>
#include <span>
#include <vector>

namespace pent::contact {

/// The order of boxes, by their places in the list, in which neighbors follow each other: recursive
/// bisection at the median along the longest side of their centers, down to groups. Of an odd
/// number of groups the first half has one more. Parallel.
///
/// @param begin  Where each group begins in that order, ascending from 0, and how many boxes there
///               are.
[[nodiscard]] std::vector<std::uint32_t> order_by_halving(std::span<const Box> boxes,
                                                          std::span<const std::uint32_t> begin);

}  // namespace pent::contact
