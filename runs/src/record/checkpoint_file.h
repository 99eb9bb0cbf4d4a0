#pragma once

#include "record/state_blocks.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace pent::runs {

/// RUN/checkpoint/000123.state: what it takes beside the files of a frame to go on behind it.
///
///     pent checkpoint 1\n
///     frame, step                                    64 bits each
///     for each block: length of its name (64 bits), the name, its bytes (64 bits), the bytes
///     crc32c of everything above                     32 bits
///
/// All numbers are little-endian. Blocks that a reader does not know are left alone.
void write_checkpoint(const std::filesystem::path& path,
                      std::uint64_t frame,
                      std::uint64_t step,
                      const StateBlocks& blocks);

/// Throws an Error that names the file if it is not there, damaged, or of another frame or step.
[[nodiscard]] StateBlocks read_checkpoint(const std::filesystem::path& path,
                                          std::uint64_t frame,
                                          std::uint64_t step);

}  // namespace pent::runs
