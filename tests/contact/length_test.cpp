#include <pent/contact/length.h>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <random>

namespace pent::contact {
namespace {

template <typename T>
class LengthTest : public testing::Test {
protected:
    // A point and a facet, or an edge and the rest: any weights will do for the formulas.
    Stencil<T::value> points() {
        return Stencil<T::value>::NullaryExpr([&] { return coordinate_(random_); });
    }
    Weights<T::value> weights() {
        Weights<T::value> w = Weights<T::value>::NullaryExpr([&] { return coordinate_(random_); });
        return w;
    }

    // Moves the points so that their combination has the length `l`, along a random direction.
    Stencil<T::value> points_at(double l, const Weights<T::value>& w) {
        Stencil<T::value> v = points();
        const Vector<T::value> direction =
            Vector<T::value>::NullaryExpr([&] { return coordinate_(random_); }).normalized();
        v += (l * direction - v * w) * w.transpose() / w.squaredNorm();
        return v;
    }

    static Stencil<T::value> moved(const Stencil<T::value>& v,
                                   const StencilVector<T::value>& along,
                                   double h) {
        return v + h * Eigen::Map<const Stencil<T::value>>(along.data());
    }

    std::mt19937 random_{11};
    std::uniform_real_distribution<double> coordinate_{-1, 1};
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(LengthTest, Dimensions);

TYPED_TEST(LengthTest, GradientIsTheCentralDifference) {
    constexpr int kDim = TypeParam::value;
    for (const double l : {1.0, 1e-3, 1e-6}) {
        const Weights<kDim> w = this->weights();
        const Stencil<kDim> v = this->points_at(l, w);
        const StencilVector<kDim> gradient = length_gradient<kDim>(v, w);
        const double h = 1e-4 * l;
        for (int i = 0; i < gradient.size(); ++i) {
            const StencilVector<kDim> axis = StencilVector<kDim>::Unit(i);
            const double difference = (length<kDim>(this->moved(v, axis, h), w)
                                       - length<kDim>(this->moved(v, axis, -h), w))
                                      / (2 * h);
            // Truncation (h / l)^2 = 1e-8; rounding 1e-16 / h, largest at l = 1e-6.
            EXPECT_NEAR(gradient[i], difference, 1e-8 + 1e-15 / h);
        }
        // Along the gradient the length grows by |gradient|^2 = |w|^2.
        EXPECT_NEAR(gradient.squaredNorm(), w.squaredNorm(), 1e-14);
        EXPECT_NEAR((length<kDim>(this->moved(v, gradient, h), w) - l) / h, w.squaredNorm(),
                    1e-8 + 1e-15 / h);
    }
}

TYPED_TEST(LengthTest, HessianIsTheCentralDifferenceOfTheGradient) {
    constexpr int kDim = TypeParam::value;
    for (const double l : {1.0, 1e-3}) {
        const Weights<kDim> w = this->weights();
        const Stencil<kDim> v = this->points_at(l, w);
        const StencilMatrix<kDim> hessian = length_hessian<kDim>(v, w);
        const double h = 1e-4 * l;
        for (int i = 0; i < hessian.cols(); ++i) {
            const StencilVector<kDim> axis = StencilVector<kDim>::Unit(i);
            const StencilVector<kDim> difference =
                (length_gradient<kDim>(this->moved(v, axis, h), w)
                 - length_gradient<kDim>(this->moved(v, axis, -h), w))
                / (2 * h);
            EXPECT_LT((hessian.col(i) - difference).norm() * l, 1e-7);  // truncation (h / l)^2
        }
        // The gradient is in its null space.
        EXPECT_LT((hessian * length_gradient<kDim>(v, w)).norm() * l, 1e-14);
    }
}

TYPED_TEST(LengthTest, EigensystemIsThatOfTheDenseHessian) {
    constexpr int kDim = TypeParam::value;
    for (int trial = 0; trial < 20; ++trial) {
        const double slope = trial % 2 == 0 ? -0.7 : 0.4;
        const double curvature = 1.3;
        const Weights<kDim> w = this->weights();
        const Stencil<kDim> v = this->points_at(0.5, w);
        const StencilVector<kDim> g = length_gradient<kDim>(v, w);
        const StencilMatrix<kDim> hessian =
            curvature * g * g.transpose() + slope * length_hessian<kDim>(v, w);
        const LengthEigensystem<kDim> system = length_eigensystem<kDim>(v, w, slope, curvature);
        Eigen::Matrix<double, Eigen::Dynamic, 1> expected =
            Eigen::Matrix<double, Eigen::Dynamic, 1>::Zero(hessian.cols());
        expected[0] = system.compression;
        expected.segment(1, kDim - 1).setConstant(system.buckling);
        std::sort(expected.begin(), expected.end());
        // Of dynamic size: compiled once for both dimensions.
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(hessian);
        EXPECT_LT((solver.eigenvalues() - expected).norm(), 1e-13);
        EXPECT_LT((hessian * g - system.compression * g).norm(), 1e-13);
        EXPECT_NEAR(system.direction.dot((v * w).normalized()), 1, 1e-15);
    }
}

TYPED_TEST(LengthTest, HasNoDirectionAtLengthZero) {
    constexpr int kDim = TypeParam::value;
    const Weights<kDim> w = this->weights();
    const Stencil<kDim> v = Stencil<kDim>::Zero();
    EXPECT_EQ(length<kDim>(v, w), 0);
    EXPECT_EQ(length_gradient<kDim>(v, w).norm(), 0);
    EXPECT_EQ(length_hessian<kDim>(v, w).norm(), 0);
}

}  // namespace
}  // namespace pent::contact
