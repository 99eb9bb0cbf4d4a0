#pragma once

#include <cstddef>
#include <cstdint>

namespace pent {

/// Checksum CRC-32C (Castagnoli polynomial, reflected 0x82F63B78) of some bytes.
///
/// @param before  Checksum of the bytes in front of these, to go on from; 0 at the start.
/// Source: [koopman2002]; the variant of iSCSI, RFC 3720. "123456789" gives e3069283.
[[nodiscard]] std::uint32_t crc32c(const void* data, std::size_t bytes, std::uint32_t before = 0);

}  // namespace pent
