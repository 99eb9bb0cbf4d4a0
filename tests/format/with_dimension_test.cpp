#include <pent/with_dimension.h>

#include <gtest/gtest.h>

#include <array>

namespace pent {
namespace {

TEST(WithDimension, CallsTheCodeOfThatDimensionAndReturnsWhatItDoes) {
    const auto size_in = [](auto dim) { return std::array<double, dim>().size(); };
    EXPECT_EQ(with_dimension(3, size_in), 3U);
    EXPECT_EQ(with_dimension(4, size_in), 4U);
}

TEST(WithDimension, HandsOnReferencesAndNothing) {
    int calls = 0;
    with_dimension(3, [&](auto dim) { calls += dim; });
    EXPECT_EQ(calls, 3);
    int& same = with_dimension(4, [&](auto /*dim*/) -> int& { return calls; });
    EXPECT_EQ(&same, &calls);
}

}  // namespace
}  // namespace pent
