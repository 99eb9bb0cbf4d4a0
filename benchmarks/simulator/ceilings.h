#pragma once

#include "kernels/kernels.h"

#include <pent/parallel.h>

namespace pent::simulator::bench {

/// What the machine can do, measured with the threads of a kernel in the same minute: what no
/// kernel can pass.
struct Ceilings {
    double memory = 0;  ///< Bytes a second of a triad over 192 MB.
    double cache = 0;   ///< Bytes a second of a triad over 16 MB, the size of the beam's matrix.
    double float_flops = 0;   ///< Of fused multiply-adds, two each, in the widest vectors.
    double double_flops = 0;  ///< The same.
};

/// One measurement; medians of several are taken elsewhere.
[[nodiscard]] Ceilings measure_ceilings(const Workers& workers);

/// What a piece of work has to do at least.
struct Work {
    double float_flops = 0;
    double double_flops = 0;
    double bytes = 0;  ///< Read or written once.

    Work& operator+=(const Work& other);
};

/// Seconds below which the work cannot be done: the longer one of arithmetic and traffic, the
/// latter at the speed of the cache where all of it fits there.
[[nodiscard]] double least_seconds(const Work& work, const Ceilings& ceilings);

}  // namespace pent::simulator::bench
