#pragma once

#include <cstdint>

namespace pent {

/// Bytes of main memory of this machine, whatever of it others use.
[[nodiscard]] std::int64_t machine_memory();

}  // namespace pent
