#include "common/progress.h"

#include <gtest/gtest.h>

namespace pent::apps {
namespace {

TEST(ReadableTime, UsesTheUnitsThatAPersonWould) {
    EXPECT_EQ(readable_time(0.04), "0.0 s");
    EXPECT_EQ(readable_time(9.94), "9.9 s");
    EXPECT_EQ(readable_time(9.96), "10 s");
    EXPECT_EQ(readable_time(59.4), "59 s");
    EXPECT_EQ(readable_time(185), "3 min 05 s");
    EXPECT_EQ(readable_time(3599.4), "59 min 59 s");
    EXPECT_EQ(readable_time(7620), "2 h 07 min");
}

TEST(ReadableRate, HasThreeDigitsAndNoPowersOfTen) {
    EXPECT_EQ(readable_rate(0.02134), "0.0213");
    EXPECT_EQ(readable_rate(2.5), "2.5");
    EXPECT_EQ(readable_rate(999.4), "999");
    EXPECT_EQ(readable_rate(999.6), "1000");
    EXPECT_EQ(readable_rate(11712.3), "11712");
}

TEST(Progress, PrintsPlainLinesWhenPipedAndNothingWhenQuiet) {
    testing::internal::CaptureStdout();
    {
        Progress progress("frames", 3, false);
        progress.update(1);
        progress.update(3, "12 iterations");
    }
    const std::string text = testing::internal::GetCapturedStdout();
    EXPECT_NE(text.find("frames 3 of 3"), std::string::npos) << text;
    EXPECT_NE(text.find("; 12 iterations"), std::string::npos) << text;
    EXPECT_EQ(text.find('\r'), std::string::npos);

    testing::internal::CaptureStdout();
    {
        Progress progress("frames", 3, true);
        progress.update(3);
    }
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

}  // namespace
}  // namespace pent::apps
