#pragma once

#include <cstddef>
#include <cstdint>

namespace pent {

/// Checksum CRC-32C (Castagnoli polynomial, reflected 0x82F63B78) of some bytes.
///
/// @param before  Checksum of the bytes in front of these, to go on from; 0 at the start.
/// Source: [koopman2002]; the variant of iSCSI, RFC 3720. "123456789" gives e3069283.
[[nodiscard]] std::uint32_t crc32c(const void* data, std::size_t bytes, std::uint32_t before = 0);

/// Checksum of some bytes and of others behind them, from the checksums of either: a product of
/// polynomials, in a time that grows with the logarithm of their number.
///
/// @param second_bytes  How many the others are.
[[nodiscard]] std::uint32_t crc32c_joined(std::uint32_t first,
                                          std::uint32_t second,
                                          std::uint64_t second_bytes);

}  // namespace pent
