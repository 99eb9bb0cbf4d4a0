#pragma once

#include <pent/simulator/solver_options.h>

namespace pent::simulator::bench {

/// Operations (additions, multiplications, divisions, roots) that the kernels take for one element
/// of stable neo-Hookean material, counted by running them on a number that counts.
struct FlopCount {
    double forces = 0;   ///< In double.
    double hessian = 0;  ///< Projected, all blocks, in float; sums into the matrix not counted.
};

/// The mean over a box of 4D cells whose vertices have moved by a tenth of an edge.
[[nodiscard]] FlopCount count_flops(ElementKind kind);

}  // namespace pent::simulator::bench
