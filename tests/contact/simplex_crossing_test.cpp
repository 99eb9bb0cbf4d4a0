#include "simplex_crossing.h"

#include "support/crossing_checker.h"

#include <gtest/gtest.h>

#include <random>

namespace pent::contact {
namespace {

template <typename T>
class SimplexCrossing : public testing::Test {
protected:
    template <int Count>
    Corners<T::value, Count> corners() {
        return Corners<T::value, Count>::NullaryExpr([&] { return coordinate_(random_); });
    }

    template <int K, int L>
    void expect_agreement() {
        int crossing = 0;
        for (int k = 0; k < 2000; ++k) {
            const Corners<T::value, K> a = this->template corners<K>();
            const Corners<T::value, L> b = this->template corners<L>();
            const bool is_true = pent::test::do_cross<T::value, K, L>(
                a.template cast<long double>(), b.template cast<long double>());
            EXPECT_EQ((is_crossing<T::value, K, L>(a, b)), is_true);
            crossing += is_true ? 1 : 0;
        }
        EXPECT_GT(crossing, 20);
    }

    std::mt19937 random_{23};
    std::uniform_real_distribution<double> coordinate_{-1, 1};
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(SimplexCrossing, Dimensions);

TYPED_TEST(SimplexCrossing, IsWhereTheirHullsMeetInside) {
    constexpr int kDim = TypeParam::value;
    this->template expect_agreement<2, kDim>();
    if constexpr (kDim == 4) {
        this->template expect_agreement<3, 3>();
    }
}

// Where a sign is in doubt it is not for determinants to tell.
TYPED_TEST(SimplexCrossing, IsNoneOfSimplicesThatTouch) {
    constexpr int kDim = TypeParam::value;
    Corners<kDim, kDim> facet = Corners<kDim, kDim>::Zero();
    for (int i = 1; i < kDim; ++i) {
        facet(i - 1, i) = 1;
    }
    Corners<kDim, 2> edge = Corners<kDim, 2>::Constant(0.2);
    edge.row(kDim - 1) << 0, 1;  // stands on it
    EXPECT_FALSE((is_crossing<kDim, 2, kDim>(edge, facet)));
    edge(kDim - 1, 0) = -1e-6;
    EXPECT_TRUE((is_crossing<kDim, 2, kDim>(edge, facet)));
}

}  // namespace
}  // namespace pent::contact
