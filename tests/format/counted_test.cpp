#include <pent/counted.h>

#include <gtest/gtest.h>

namespace pent {
namespace {

TEST(Counted, IsOneThingOrAnyOtherNumberOfThem) {
    EXPECT_EQ(counted(1, "vertex", "vertices"), "1 vertex");
    EXPECT_EQ(counted(0, "vertex", "vertices"), "0 vertices");
    EXPECT_EQ(counted(2, "vertex", "vertices"), "2 vertices");
    EXPECT_EQ(counted(-1, "layer", "layers"), "-1 layers");
}

}  // namespace
}  // namespace pent
