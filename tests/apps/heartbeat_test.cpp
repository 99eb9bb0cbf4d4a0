#include "common/heartbeat.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace pent::apps {
namespace {

using std::chrono::milliseconds;

// What it says while half a second passes.
std::string said(bool quiet, milliseconds between) {
    testing::internal::CaptureStdout();
    {
        Heartbeat heartbeat(quiet, between);
        heartbeat.begin("fill");
        std::this_thread::sleep_for(milliseconds(500));
    }
    return testing::internal::GetCapturedStdout();
}

TEST(Heartbeat, SaysWhatIsDoneOnceItsTimeHasCome) {
    EXPECT_EQ(said(false, milliseconds(20)).rfind("working    fill, 0 s\n", 0), 0U);
    EXPECT_EQ(said(false, milliseconds(60'000)), "");
}

// Something is said every 20 ms, so that half a second without would be twice the time.
TEST(Heartbeat, IsSilentWhileOthersSpeak) {
    testing::internal::CaptureStdout();
    {
        Heartbeat heartbeat(false, milliseconds(250));
        heartbeat.begin("fill");
        for (int i = 0; i < 25; ++i) {
            std::this_thread::sleep_for(milliseconds(20));
            heartbeat.spoken();
        }
    }
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST(Heartbeat, IsSilentWhereQuietIsAsked) {
    EXPECT_EQ(said(true, milliseconds(20)), "");
}

}  // namespace
}  // namespace pent::apps
