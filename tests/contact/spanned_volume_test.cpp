#include "spanned_volume.h"

#include "pairs.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace pent::contact {
namespace {

template <typename T>
class SpannedVolume : public testing::Test {
protected:
    // The ridge first, the edge last.
    static Stencil<T::value> swapped(const Stencil<T::value>& points) {
        Stencil<T::value> result;
        result << points.template rightCols<T::value - 1>(), points.template leftCols<2>();
        return result;
    }

    test::RandomCorners random_{3};
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(SpannedVolume, Dimensions);

TYPED_TEST(SpannedVolume, IsTheGramDeterminantOfTheEdges) {
    constexpr int kDim = TypeParam::value;
    for (int k = 0; k < 20; ++k) {
        const Stencil<kDim> v = this->random_.template stencil<kDim>();
        Eigen::Matrix<double, kDim, kDim - 1> edges;
        edges.col(0) = v.col(1) - v.col(0);
        for (int i = 1; i < kDim - 1; ++i) {
            edges.col(i) = v.col(2 + i) - v.col(2);
        }
        EXPECT_NEAR(spanned_volume_squared<kDim>(v), (edges.transpose() * edges).determinant(),
                    1e-12);
    }
}

TYPED_TEST(SpannedVolume, IsTheSameWhicheverSimplexComesFirst) {
    constexpr int kDim = TypeParam::value;
    const Stencil<kDim> v = this->random_.template stencil<kDim>();
    const Stencil<kDim> w = this->swapped(v);
    EXPECT_DOUBLE_EQ(spanned_volume_squared<kDim>(v), spanned_volume_squared<kDim>(w, kDim - 1));
    const StencilVector<kDim> of_w = spanned_volume_squared_gradient<kDim>(w, kDim - 1);
    const Stencil<kDim> gradient =
        spanned_volume_squared_gradient<kDim>(v).reshaped(kDim, kDim + 1);
    EXPECT_LT((of_w - StencilVector<kDim>(this->swapped(gradient).reshaped())).norm(), 1e-13);
}

TYPED_TEST(SpannedVolume, IsZeroWhereTheEdgeHasADirectionOfTheRidge) {
    constexpr int kDim = TypeParam::value;
    Stencil<kDim> v = this->random_.template stencil<kDim>();
    v.col(1) = v.col(0) + 0.7 * (v.col(kDim) - v.col(2));
    EXPECT_NEAR(spanned_volume_squared<kDim>(v), 0, 1e-28);
    EXPECT_NEAR(spanned_volume_squared_gradient<kDim>(v).norm(), 0, 1e-13);  // a minimum
}

TYPED_TEST(SpannedVolume, HasDerivativesThatAreCentralDifferences) {
    constexpr int kDim = TypeParam::value;
    const double h = 1e-5;
    for (const int first_count : {2, kDim - 1}) {
        for (int k = 0; k < 20; ++k) {
            const Stencil<kDim> v = this->random_.template stencil<kDim>();
            const StencilVector<kDim> gradient =
                spanned_volume_squared_gradient<kDim>(v, first_count);
            const StencilMatrix<kDim> hessian =
                spanned_volume_squared_hessian<kDim>(v, first_count);
            for (int i = 0; i < gradient.size(); ++i) {
                const Stencil<kDim> plus = test::moved<kDim>(v, i, h);
                const Stencil<kDim> minus = test::moved<kDim>(v, i, -h);
                // A polynomial of degree 6 in coordinates of size 1: truncation h^2 = 1e-10 times
                // 100.
                EXPECT_NEAR(gradient[i],
                            (spanned_volume_squared<kDim>(plus, first_count)
                             - spanned_volume_squared<kDim>(minus, first_count))
                                / (2 * h),
                            1e-7);
                EXPECT_LT((hessian.col(i)
                           - (spanned_volume_squared_gradient<kDim>(plus, first_count)
                              - spanned_volume_squared_gradient<kDim>(minus, first_count))
                                 / (2 * h))
                              .norm(),
                          1e-6);
            }
        }
    }
}

}  // namespace
}  // namespace pent::contact
