#include "apart.h"

#include "closest_points_oracle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pent::contact {
namespace {

template <typename T>
class ApartTest : public testing::Test {};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(ApartTest, Dimensions);

TYPED_TEST(ApartTest, NothingThatIsNearIsApart) {
    constexpr int kDim = TypeParam::value;
    using First = Corners<kDim, 2>;
    using Second = Corners<kDim, kDim - 1>;
    std::mt19937 random(11);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    const auto number = [&] { return coordinate(random); };
    int apart = 0;
    for (int i = 0; i < 2000; ++i) {
        const First a = First::NullaryExpr(number);
        const First a_end = a + 0.3 * First::NullaryExpr(number);
        const Second b = Second::NullaryExpr(number);
        const Second b_end = b + 0.3 * Second::NullaryExpr(number);
        const double limit = 0.1 + 0.4 * std::abs(number());
        const double start = test::brute_force_distance<kDim, 2, kDim - 1>(a, b);
        const bool is_apart = are_boxes_apart<kDim, 2, kDim - 1>(a, b, limit * limit)
                              || are_apart_along_middles<kDim, 2, kDim - 1>(a, b, limit);
        EXPECT_FALSE(is_apart && start < limit * (1 - 1e-12));
        const bool are_paths =
            are_paths_apart<kDim, 2, kDim - 1>(a, a_end, b, b_end, limit * limit);
        for (int k = 0; are_paths && k <= 10; ++k) {
            const double t = 0.1 * k;
            EXPECT_GT((test::brute_force_distance<kDim, 2, kDim - 1>(a + t * (a_end - a),
                                                                     b + t * (b_end - b))),
                      limit * (1 - 1e-12));
        }
        apart += are_paths ? 1 : 0;
    }
    EXPECT_GT(apart, 200);
}

// Simplices that cross in their middles have no line through these to be apart along.
TYPED_TEST(ApartTest, WhatCrossesInItsMiddleIsNotApart) {
    constexpr int kDim = TypeParam::value;
    Corners<kDim, 2> edge = Corners<kDim, 2>::Zero();
    edge(0, 0) = -1;
    edge(0, 1) = 1;
    Corners<kDim, kDim - 1> other = Corners<kDim, kDim - 1>::Zero();
    for (int corner = 0; corner < kDim - 1; ++corner) {
        const double angle = 2 * M_PI * corner / (kDim - 1);
        other(1, corner) = kDim == 3 ? 1 - 2 * corner : std::cos(angle);
        other(2, corner) = kDim == 3 ? 0 : std::sin(angle);
    }
    other.colwise() -= other.rowwise().mean().eval();
    EXPECT_FALSE((are_apart_along_middles<kDim, 2, kDim - 1>(edge, other, 0.1)));
}

}  // namespace
}  // namespace pent::contact
