#include "pent/crc32c.h"

#include <array>
#include <bit>
#include <cstring>

namespace pent {

static_assert(std::endian::native == std::endian::little, ".pent files are little-endian");

namespace {

// tables[k][b] is the effect of byte b on the register k bytes later, so that eight bytes are done
// in one go ("slicing by eight"): several times the speed of one table.
using Tables = std::array<std::array<std::uint32_t, 256>, 8>;

constexpr Tables make_tables() {
    Tables tables{};
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
        std::uint32_t value = byte;
        for (int bit = 0; bit < 8; ++bit) {
            value = (value >> 1) ^ ((value & 1) != 0 ? 0x82F63B78U : 0U);
        }
        tables[0][byte] = value;
    }
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
        for (std::size_t k = 1; k < 8; ++k) {
            const std::uint32_t value = tables[k - 1][byte];
            tables[k][byte] = (value >> 8) ^ tables[0][value & 255];
        }
    }
    return tables;
}

constexpr Tables kTables = make_tables();

// Polynomials over two elements modulo that of the checksum. As in the register the highest bit is
// the constant term.
constexpr std::uint32_t kOne = 0x80000000U;

std::uint32_t product(std::uint32_t a, std::uint32_t b) {
    std::uint32_t sum = 0;
    for (std::uint32_t bit = kOne; bit != 0; bit >>= 1) {
        sum ^= (a & bit) != 0 ? b : 0U;
        b = (b >> 1) ^ ((b & 1) != 0 ? 0x82F63B78U : 0U);  // times x
    }
    return sum;
}

}  // namespace

std::uint32_t crc32c(const void* data, std::size_t bytes, std::uint32_t before) {
    const auto* at = static_cast<const unsigned char*>(data);
    std::uint32_t crc = ~before;
    for (; bytes >= 8; at += 8, bytes -= 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, at, 8);
        word ^= crc;
        crc = 0;
        for (std::size_t k = 0; k < 8; ++k) {
            crc ^= kTables[7 - k][(word >> (8 * k)) & 255];
        }
    }
    for (; bytes > 0; ++at, --bytes) {
        crc = (crc >> 8) ^ kTables[0][(crc ^ *at) & 255];
    }
    return ~crc;
}

// Each byte behind multiplies what the first bytes left in the register by x^8.
std::uint32_t crc32c_joined(std::uint32_t first, std::uint32_t second, std::uint64_t second_bytes) {
    std::uint32_t factor = kOne;
    std::uint32_t power = kOne >> 8;
    for (; second_bytes > 0; second_bytes >>= 1) {
        factor = (second_bytes & 1) != 0 ? product(factor, power) : factor;
        power = product(power, power);
    }
    return product(first, factor) ^ second;
}

}  // namespace pent
