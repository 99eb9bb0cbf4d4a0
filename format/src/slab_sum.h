#pragma once

#include <pent/slab_writers.h>

#include <cstdint>

namespace pent {

/// Checksum of the slabs of all writers, one behind the other; each gives that of its own.
///
/// @param writers  Null for one alone.
/// @param bytes    Of the own one.
[[nodiscard]] std::uint32_t joined_crc32c(const SlabWriters* writers,
                                          std::uint32_t own,
                                          std::uint64_t bytes);

}  // namespace pent
