#pragma once

#include <pent/mesher/surface.h>

namespace pent::mesher {

/// Whether a triangle has a corner twice or its corners on one line. Exact.
[[nodiscard]] bool is_degenerate(const Surface& surface, Eigen::Index triangle);

}  // namespace pent::mesher
