#include <pent/base64.h>

#include <gtest/gtest.h>

#include <string>

namespace pent {
namespace {

// RFC 4648, section 10.
TEST(Base64, IsThatOfItsStandard) {
    EXPECT_EQ(to_base64(""), "");
    EXPECT_EQ(to_base64("f"), "Zg==");
    EXPECT_EQ(to_base64("fo"), "Zm8=");
    EXPECT_EQ(to_base64("foo"), "Zm9v");
    EXPECT_EQ(to_base64("foob"), "Zm9vYg==");
    EXPECT_EQ(to_base64("fooba"), "Zm9vYmE=");
    EXPECT_EQ(to_base64("foobar"), "Zm9vYmFy");
}

TEST(Base64, GivesBackEveryByte) {
    std::string bytes;
    for (int i = 0; i < 1000; ++i) {
        bytes += static_cast<char>(i * 7);
        EXPECT_EQ(from_base64(to_base64(bytes)), bytes);
    }
}

TEST(Base64, IsRefusedWhereItIsNone) {
    for (const char* text : {"Z", "Zg", "Zg=", "Zg=g", "====", "Zm9v=", "Zm9!", "Zm 9v", "=Zm9"}) {
        EXPECT_EQ(from_base64(text), std::nullopt) << text;
    }
}

TEST(Base64Prefix, PassesThePaddingOfTextsOneBehindTheOther) {
    const std::string text =
        " " + to_base64("abcd") + "\n\t" + to_base64("efghi") + to_base64("jkl");
    EXPECT_EQ(from_base64_prefix(text, 12), "abcdefghijkl");
    EXPECT_EQ(from_base64_prefix(text, 100), "abcdefghijkl");
    // Three bytes at a time, and what is behind those asked for is not looked at.
    EXPECT_EQ(from_base64_prefix(text + "!", 12), "abcdefghijkl");
    EXPECT_EQ(from_base64_prefix(text, 2), "abc");
    EXPECT_EQ(from_base64_prefix("", 5), "");
}

TEST(Base64Prefix, IsNothingForOtherTexts) {
    for (const char* text : {"abc", "ab!=", "a===", "=abc", "abcde"}) {
        EXPECT_EQ(from_base64_prefix(text, 9), std::nullopt) << text;
    }
}

}  // namespace
}  // namespace pent
