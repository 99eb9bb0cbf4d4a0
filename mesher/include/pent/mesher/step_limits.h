#pragma once

#include <cstdint>

namespace pent::mesher {

/// What a step may take that runs in a process of its own because its library may crash or run
/// away. Past a limit the step has failed and the next way is tried.
struct StepLimits {
    double seconds = 300;            ///< Of processor time, above 0; counted in whole seconds.
    std::int64_t memory_mib = 8192;  ///< Of address space, above 0.
};

}  // namespace pent::mesher
