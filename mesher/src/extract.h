#pragma once

#include <pent/mesher/surface.h>

#include <span>

namespace pent::mesher {

/// Some triangles of a surface with the points they use, both in their old order.
[[nodiscard]] Surface extract(const Surface& surface, std::span<const std::uint32_t> triangles);

}  // namespace pent::mesher
