#include <pent/formatted.h>

#include <gtest/gtest.h>

namespace pent {
namespace {

TEST(Formatted, WritesWhatPrintfWould) {
    EXPECT_EQ(formatted("%.3g m, %d of %s, %06d%%", 0.25, 3, "five", 42),
              "0.25 m, 3 of five, 000042%");
    EXPECT_EQ(formatted("%s", ""), "");
}

TEST(Formatted, HasNoLargestLength) {
    const std::string body(100'000, 'x');
    EXPECT_EQ(formatted("<%s>", body.c_str()), "<" + body + ">");
}

}  // namespace
}  // namespace pent
