#include "orientation.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <type_traits>

namespace pent::contact {
namespace {

__extension__ using Integer = __int128;

template <typename T>
class Orientation : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 1>,
                                  std::integral_constant<int, 2>,
                                  std::integral_constant<int, 3>,
                                  std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(Orientation, Dimensions);

template <int N>
using Points = Eigen::Matrix<double, N, N + 1>;

template <int N>
Integer determinant(const Eigen::Matrix<Integer, N, N>& matrix) {
    if constexpr (N == 1) {
        return matrix(0, 0);
    } else {
        Integer sum = 0;
        for (int k = 0; k < N; ++k) {
            Eigen::Matrix<Integer, N - 1, N - 1> rest;
            for (int column = 0; column < N - 1; ++column) {
                rest.col(column) =
                    matrix.col(column < k ? column : column + 1).template tail<N - 1>();
            }
            sum += (k % 2 == 0 ? 1 : -1) * matrix(0, k) * determinant<N - 1>(rest);
        }
        return sum;
    }
}

// Of points of whole numbers, which integers do not round.
template <int N>
int expected(const Points<N>& points) {
    Eigen::Matrix<Integer, N, N> edges;
    for (int k = 0; k < N; ++k) {
        for (int axis = 0; axis < N; ++axis) {
            edges(axis, k) =
                static_cast<Integer>(points(axis, k + 1)) - static_cast<Integer>(points(axis, 0));
        }
    }
    const Integer det = determinant<N>(edges);
    return det == 0 ? 0 : det > 0 ? 1 : -1;
}

TYPED_TEST(Orientation, IsThatOfIntegersOnASmallLattice) {
    constexpr int kDim = TypeParam::value;
    std::mt19937 random(1);
    std::uniform_int_distribution<int> coordinate(-2, 2);
    int flat = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        const Points<kDim> points = Points<kDim>::NullaryExpr([&] { return coordinate(random); });
        const int sign = expected<kDim>(points);
        ASSERT_EQ(orientation<kDim>(points), sign) << points;
        flat += sign == 0 ? 1 : 0;
    }
    EXPECT_GT(flat, 100);
}

// Points on a line but for a unit in their last places: the products of a determinant cancel, and
// in floating point what is left of them is rounding.
TYPED_TEST(Orientation, IsExactWhereRoundingWouldDecide) {
    constexpr int kDim = TypeParam::value;
    constexpr double kSizes[] = {0x1p51, 0x1p51, 0x1p38, 0x1p26};  // products fit into integers
    std::mt19937 random(2);
    std::uniform_real_distribution<double> coordinate(-kSizes[kDim - 1], kSizes[kDim - 1]);
    std::uniform_int_distribution<int> unit(-1, 1);
    int wrong = 0;  // in floating point
    int signs[3] = {};
    for (int trial = 0; trial < 3000; ++trial) {
        using Vector = Eigen::Matrix<double, kDim, 1>;
        const auto any = [&] { return std::round(coordinate(random)); };
        const Vector way = Vector::NullaryExpr(any);
        Points<kDim> points;
        points.col(0) = Vector::NullaryExpr(any);
        for (int k = 1; k <= kDim; ++k) {
            points.col(k) =
                points.col(0) + k * way + Vector::NullaryExpr([&] { return unit(random); });
        }
        const int sign = expected<kDim>(points);
        ASSERT_EQ(orientation<kDim>(points), sign) << points;
        ++signs[sign + 1];
        const Eigen::Matrix<double, kDim, kDim> edges =
            points.template rightCols<kDim>().colwise() - points.col(0);
        const double rounded = edges.determinant();
        wrong += (rounded > 0 ? 1 : rounded < 0 ? -1 : 0) != sign ? 1 : 0;
        points.col(0).swap(points.col(kDim));
        ASSERT_EQ(orientation<kDim>(points), -sign) << points;
    }
    EXPECT_GT(signs[0], 500);
    EXPECT_GT(signs[2], 500);
    EXPECT_TRUE(kDim == 1 || wrong > 100) << wrong;
}

}  // namespace
}  // namespace pent::contact
