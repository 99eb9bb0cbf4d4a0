#include <pent/crc32c.h>

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace pent {
namespace {

// The definition, bit by bit.
std::uint32_t crc32c_by_bits(std::string_view bytes) {
    std::uint32_t crc = 0xFFFFFFFFU;
    for (const char byte : bytes) {
        crc ^= static_cast<unsigned char>(byte);
        for (int bit = 0; bit < 8; ++bit) {
            crc = (crc & 1) != 0 ? (crc >> 1) ^ 0x82F63B78U : crc >> 1;
        }
    }
    return ~crc;
}

TEST(Crc32c, GivesThePublishedValues) {
    EXPECT_EQ(crc32c("123456789", 9), 0xE3069283U);
    EXPECT_EQ(crc32c(std::string(32, '\0').data(), 32), 0x8A9136AAU);  // RFC 3720, B.4
    EXPECT_EQ(crc32c(std::string(32, '\xFF').data(), 32), 0x62A8AB43U);
    EXPECT_EQ(crc32c("", 0), 0U);
}

TEST(Crc32c, EqualsTheDefinitionAtEveryLength) {
    std::string bytes;
    for (int length = 0; length < 70; ++length) {
        EXPECT_EQ(crc32c(bytes.data(), bytes.size()), crc32c_by_bits(bytes)) << length;
        bytes += static_cast<char>(length * 37 + 11);
    }
}

TEST(Crc32c, CanGoOnFromAnEarlierPart) {
    const std::string bytes = "a body that comes in several parts";
    for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
        const std::uint32_t first = crc32c(bytes.data(), cut);
        EXPECT_EQ(crc32c(bytes.data() + cut, bytes.size() - cut, first),
                  crc32c(bytes.data(), bytes.size()));
    }
}

}  // namespace
}  // namespace pent
