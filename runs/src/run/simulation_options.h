#pragma once

#include <pent/machine_memory.h>
#include <pent/runs/run.h>

namespace pent::runs {

/// What a run asks of its simulation, which may take all memory of the machine.
[[nodiscard]] inline simulator::SimulationOptions simulation_options(const RunOptions& options) {
    return {.threads = options.threads,
            .isa = options.isa,
            .ranks = options.ranks,
            .memory = machine_memory()};
}

}  // namespace pent::runs
