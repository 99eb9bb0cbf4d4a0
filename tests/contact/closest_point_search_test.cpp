#include "closest_point_search.h"

#include "closest_points_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <random>

namespace pent::contact {
namespace {

// Corners are about 1 m apart: distances of a few m have rounding errors of some 1e-15 m.
constexpr double kRounding = 2e-14;

template <int DimValue, int KValue, int LValue>
struct Kind {
    static constexpr int kDim = DimValue;
    static constexpr int kK = KValue;
    static constexpr int kL = LValue;
    using First = Corners<kDim, kK>;
    using Second = Corners<kDim, kL>;
};

template <typename T>
class ClosestPointsTest : public testing::Test {
protected:
    template <typename Matrix>
    Matrix uniform() {
        std::uniform_real_distribution<double> coordinate(-1, 1);
        return Matrix::NullaryExpr([&] { return coordinate(random_); });
    }

    // Corners on a small lattice: touching, parallel, collapsed and containing all of the time.
    template <typename Matrix>
    Matrix lattice() {
        std::uniform_int_distribution<int> coordinate(0, 2);
        return Matrix::NullaryExpr([&] { return coordinate(random_); });
    }

    static void expect_right(const typename T::First& first, const typename T::Second& second) {
        const auto points = test::closest_points<T::kDim, T::kK, T::kL>(first, second);
        EXPECT_GE(points.beta.minCoeff(), 0);
        EXPECT_GE(points.alpha.minCoeff(), 0);
        EXPECT_NEAR(points.beta.sum(), 1, 1e-15);  // one subtraction from 1
        EXPECT_NEAR(points.alpha.sum(), 1, 1e-15);
        const Vector<T::kDim> difference = first * points.beta - second * points.alpha;
        EXPECT_LT((points.difference - difference).norm(), kRounding);
        EXPECT_DOUBLE_EQ(points.distance_squared, points.difference.squaredNorm());
        const double distance = std::sqrt(points.distance_squared);
        EXPECT_NEAR(distance, (test::brute_force_distance<T::kDim, T::kK, T::kL>(first, second)),
                    kRounding)
            << "first\n"
            << first << "\nsecond\n"
            << second;
        for (int i = 0; i < T::kK; ++i) {
            EXPECT_TRUE((points.first_face >> i & 1) != 0 || points.beta[i] == 0);
        }
        for (int j = 0; j < T::kL; ++j) {
            EXPECT_TRUE((points.second_face >> j & 1) != 0 || points.alpha[j] == 0);
        }
    }

    // Every order of the corners of both gives the same distance.
    static void expect_order_free(const typename T::First& first,
                                  const typename T::Second& second) {
        const double expected =
            std::sqrt(test::closest_points<T::kDim, T::kK, T::kL>(first, second).distance_squared);
        std::array<int, T::kK> p{};
        std::iota(p.begin(), p.end(), 0);
        do {
            std::array<int, T::kL> q{};
            std::iota(q.begin(), q.end(), 0);
            do {
                const typename T::First a = first(Eigen::all, p);
                const typename T::Second b = second(Eigen::all, q);
                const auto points = test::closest_points<T::kDim, T::kK, T::kL>(a, b);
                EXPECT_NEAR(std::sqrt(points.distance_squared), expected, kRounding);
            } while (std::next_permutation(q.begin(), q.end()));
        } while (std::next_permutation(p.begin(), p.end()));
    }

    std::mt19937 random_{20260401};
};

using Kinds = testing::Types<Kind<3, 1, 3>, Kind<3, 2, 2>, Kind<4, 1, 4>, Kind<4, 2, 3>>;
TYPED_TEST_SUITE(ClosestPointsTest, Kinds);

TYPED_TEST(ClosestPointsTest, AgreeWithEnumerationForRandomSimplices) {
    using First = typename TypeParam::First;
    using Second = typename TypeParam::Second;
    for (int trial = 0; trial < 1000; ++trial) {
        this->expect_right(this->template uniform<First>(), this->template uniform<Second>());
    }
}

TYPED_TEST(ClosestPointsTest, AgreeWithEnumerationForDegenerateSimplices) {
    using First = typename TypeParam::First;
    using Second = typename TypeParam::Second;
    for (int trial = 0; trial < 1500; ++trial) {
        this->expect_right(this->template lattice<First>(), this->template lattice<Second>());
    }
}

TYPED_TEST(ClosestPointsTest, AgreeWithEnumerationNextToDegenerateSimplices) {
    using First = typename TypeParam::First;
    using Second = typename TypeParam::Second;
    for (const double size : {1e-15, 1e-12, 1e-9, 1e-6, 1e-3}) {
        for (int trial = 0; trial < 400; ++trial) {
            const First first =
                this->template lattice<First>() + size * this->template uniform<First>();
            const Second second =
                this->template lattice<Second>() + size * this->template uniform<Second>();
            this->expect_right(first, second);
        }
    }
}

TYPED_TEST(ClosestPointsTest, DoNotDependOnTheOrderOfCorners) {
    using First = typename TypeParam::First;
    using Second = typename TypeParam::Second;
    for (int trial = 0; trial < 20; ++trial) {
        this->expect_order_free(this->template uniform<First>(), this->template uniform<Second>());
        const First first =
            this->template lattice<First>() + 1e-12 * this->template uniform<First>();
        this->expect_order_free(first, this->template lattice<Second>());
    }
}

TYPED_TEST(ClosestPointsTest, InsideBothAreFoundWithoutLookingAtFaces) {
    using First = typename TypeParam::First;
    using Second = typename TypeParam::Second;
    constexpr int kDim = TypeParam::kDim;
    constexpr int kK = TypeParam::kK;
    constexpr int kL = TypeParam::kL;
    int inside = 0;
    for (int trial = 0; trial < 500; ++trial) {
        const First first = this->template uniform<First>();
        const Second second = this->template uniform<Second>();
        const auto points = test::closest_points<kDim, kK, kL>(first, second);
        const bool is_inside =
            points.first_face == (1U << kK) - 1 && points.second_face == (1U << kL) - 1;
        ClosestPointSearch<kDim, kK, kL> search(first, second, 1e300);
        EXPECT_EQ(search.run_interior(), is_inside);
        if (is_inside) {
            ++inside;
            EXPECT_EQ(search.best().difference, points.difference);
        }
    }
    EXPECT_GT(inside, 10);
}

TYPED_TEST(ClosestPointsTest, AreFoundWithinALimitOnly) {
    using First = typename TypeParam::First;
    using Second = typename TypeParam::Second;
    constexpr int kDim = TypeParam::kDim;
    constexpr int kK = TypeParam::kK;
    constexpr int kL = TypeParam::kL;
    for (int trial = 0; trial < 300; ++trial) {
        const First first = this->template lattice<First>() + this->template uniform<First>();
        const Second second = this->template lattice<Second>();
        const double squared = test::closest_points<kDim, kK, kL>(first, second).distance_squared;
        ClosestPointSearch<kDim, kK, kL> below(first, second, 0.99 * squared);
        EXPECT_FALSE(below.run());
        EXPECT_FALSE(
            (ClosestPointSearch<kDim, kK, kL>(first, second, 0.99 * squared)).run_interior());
        // Leaving early may leave out the better of two ways to the same points.
        ClosestPointSearch<kDim, kK, kL> above(first, second, squared + 1);
        EXPECT_TRUE(above.run());
        EXPECT_NEAR(above.best().distance_squared, squared, kRounding);
    }
}

TEST(PointTetrahedron, FindsTheFaceBelowThePoint) {
    Corners<4, 4> facet;
    facet << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0;
    const auto points = test::closest_points<4, 1, 4>(Vector<4>(0.25, -2, 0.5, 3), facet);
    EXPECT_EQ(points.second_face, 0b1011);  // the triangle y = 0
    EXPECT_LT((points.alpha - Eigen::Vector4d(0.25, 0.25, 0, 0.5)).norm(), 1e-15);
    EXPECT_LT((points.difference - Vector<4>(0, -2, 0, 3)).norm(), 1e-15);
}

TEST(EdgeTriangle, MeetsWhereTheEdgePassesThroughTheTriangle) {
    Corners<4, 3> triangle;
    triangle << 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0;
    Corners<4, 2> edge;
    edge << 0.25, 0.25, 0.5, 0.5, -1, 3, 0, 0;
    const auto points = test::closest_points<4, 2, 3>(edge, triangle);
    EXPECT_LT(points.distance_squared, 1e-30);
    EXPECT_LT((points.beta - Eigen::Vector2d(0.75, 0.25)).norm(), 1e-15);
    EXPECT_LT((points.alpha - Eigen::Vector3d(0.25, 0.25, 0.5)).norm(), 1e-15);
}

TEST(EdgeEdge, HasTheDistanceOfParallelEdgesThatOverlap) {
    Corners<3, 2> a;
    Corners<3, 2> b;
    a << 0, 2, 0, 0, 0, 0;
    b << 1, 3, 0.5, 0.5, 0, 0;
    const auto points = test::closest_points<3, 2, 2>(a, b);
    EXPECT_DOUBLE_EQ(points.distance_squared, 0.25);
}

}  // namespace
}  // namespace pent::contact
