#pragma once

#include "ceilings.h"
#include "flop_count.h"

#include <pent/simulator/simulation.h>

namespace pent::simulator::bench {

/// The least that parts of a step in 4D have to compute, read and write, float blocks: every array
/// that is used once, however often it could stay in a cache.
struct StepWork {
    SimulationSize size;
    FlopCount flops;
    double aggregate_blocks = 0;  ///< Stored of the finest; all coarser ones are a tenth more.

    [[nodiscard]] Work forces() const;
    [[nodiscard]] Work hessian() const;       ///< Projected, and assembled.
    [[nodiscard]] Work setup() const;         ///< Of the preconditioner.
    [[nodiscard]] Work product() const;       ///< Matrix times vector.
    [[nodiscard]] Work precondition() const;  ///< Once.
    [[nodiscard]] Work vectors() const;  ///< What else an iteration of conjugate gradients does.

    /// A step of so many assemblies and iterations in all.
    [[nodiscard]] double least_step_seconds(const Ceilings& ceilings,
                                            int assemblies,
                                            int iterations) const;
};

}  // namespace pent::simulator::bench
