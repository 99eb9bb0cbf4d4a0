#include <pent/nearest_name.h>

#include <gtest/gtest.h>

namespace pent {
namespace {

TEST(NearestName, IsTheOneWithTheFewestChangedLetters) {
    EXPECT_EQ(nearest_name("gravitiy", {"frames", "gravity", "dimension"}), "gravity");
    EXPECT_EQ(nearest_name("--thraeds", {"--threads", "--thickness"}), "--threads");
    EXPECT_EQ(nearest_name("yong", {"young", "poisson"}), "young");
}

TEST(NearestName, IsNothingWhenNoneIsNear) {
    EXPECT_EQ(nearest_name("banana", {"young", "poisson"}), "");
    EXPECT_EQ(nearest_name("x", {}), "");
    EXPECT_EQ(nearest_name("", {"young"}), "");
}

TEST(NearestName, IsTheFirstOfEquals) {
    EXPECT_EQ(nearest_name("cat", {"bat", "rat"}), "bat");
}

}  // namespace
}  // namespace pent
