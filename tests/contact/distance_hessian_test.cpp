#include "distance_hessian.h"

#include "pairs.h"
#include "spectral.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace pent::contact {
namespace {

template <typename T>
class DistanceHessian : public testing::Test {
protected:
    static constexpr int kSpace = T::value;

    // Of curvature 2.
    static test::DenseSpectrum<kSpace> spectrum(const Stencil<kSpace>& points,
                                                const Contact<kSpace>& contact,
                                                double slope,
                                                Filter filter) {
        return test::spectrum_of(distance_hessian<kSpace>(points, contact, slope, 2), filter,
                                 filter == Filter::Clamp ? kSpace : 2 * kSpace - 1);
    }

    test::RandomCorners random_{3};
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(DistanceHessian, Dimensions);

TYPED_TEST(DistanceHessian, FilterIsTheOneOnAllEigenvalues) {
    constexpr int kDim = TypeParam::value;
    const auto expect = [&](const Stencil<kDim>& points, const Contact<kDim>& contact,
                            double slope) {
        const auto hessian = [&](Filter filter) {
            return this->spectrum(points, contact, slope, filter).matrix();
        };
        const StencilMatrix<kDim> exact =
            distance_hessian<kDim>(points, contact, slope, 2).matrix();
        const Eigen::SelfAdjointEigenSolver<StencilMatrix<kDim>> solver(exact);
        const auto& V = solver.eigenvectors();
        const StencilMatrix<kDim> clamped =
            V * solver.eigenvalues().cwiseMax(0).asDiagonal() * V.transpose();
        const StencilMatrix<kDim> absolute =
            V * solver.eigenvalues().cwiseAbs().asDiagonal() * V.transpose();
        const double rounding = 1e-10 * exact.norm();
        EXPECT_LT((hessian(Filter::None) - exact).norm(), rounding);
        EXPECT_LT((hessian(Filter::Clamp) - clamped).norm(), rounding);
        EXPECT_LT((hessian(Filter::Absolute) - absolute).norm(), rounding);
    };
    for (int k = 0; k < 50; ++k) {
        for (const double slope : {-1.3, 1.3}) {
            const Stencil<kDim> point = this->random_.template stencil<kDim>();
            expect(point, test::contact_at<kDim, 1, kDim>(point), slope);
            const Stencil<kDim> mixed = this->random_.template stencil<kDim>();
            expect(mixed, test::contact_at<kDim, 2, kDim - 1>(mixed), slope);
        }
    }
}

// With psi(d) = d, slope 1 and curvature 0, it is the Hessian of the distance: differences of its
// gradient.
TYPED_TEST(DistanceHessian, OfTheDistanceItselfIsTheDifferenceOfItsGradient) {
    constexpr int kDim = TypeParam::value;
    const double h = 1e-6;
    int compared = 0;
    for (int k = 0; k < 100; ++k) {
        const Stencil<kDim> points = this->random_.template stencil<kDim>();
        const Contact<kDim> contact = test::contact_at<kDim, 1, kDim>(points);
        if (contact.distance < 0.1) {
            continue;
        }
        const StencilMatrix<kDim> hessian = distance_hessian<kDim>(points, contact, 1, 0).matrix();
        for (int i = 0; i < hessian.cols(); ++i) {
            const Contact<kDim> plus =
                test::contact_at<kDim, 1, kDim>(test::moved<kDim>(points, i, h));
            const Contact<kDim> minus =
                test::contact_at<kDim, 1, kDim>(test::moved<kDim>(points, i, -h));
            if (plus.active != contact.active || minus.active != contact.active) {
                continue;  // on the border of a stratum, where the Hessian jumps
            }
            const StencilVector<kDim> change = (outer<kDim>(plus.weights, plus.direction)
                                                - outer<kDim>(minus.weights, minus.direction))
                                               / (2 * h);
            // Truncation (h / d)^2 and rounding 1e-16 / h, times the condition of the facet.
            EXPECT_LT((hessian.col(i) - change).norm(), 1e-5 * (1 + hessian.norm()));
            ++compared;
        }
    }
    EXPECT_GT(compared, 500);
}

// The points of an obstacle with a radius are farther apart than the distance says.
TYPED_TEST(DistanceHessian, CountsTheRadiusOfAnObstacle) {
    constexpr int kDim = TypeParam::value;
    const Stencil<kDim> points = this->random_.template stencil<kDim>();
    Contact<kDim> contact = test::contact_at<kDim, 1, kDim>(points);
    const StencilMatrix<kDim> expected = distance_hessian<kDim>(points, contact, -1, 2).matrix();
    contact.radius = 0.25 * contact.distance;
    contact.distance -= contact.radius;
    EXPECT_LT((distance_hessian<kDim>(points, contact, -1, 2).matrix() - expected).norm(),
              1e-13 * expected.norm());
}

// The weights cannot be told to move along an edge of one face and a parallel one of the other.
TYPED_TEST(DistanceHessian, OfParallelEdgesIsThatWithOneOfThem) {
    constexpr int kDim = TypeParam::value;
    Stencil<kDim> points = this->random_.template stencil<kDim>();
    points.col(3) = points.col(2) + 0.7 * (points.col(1) - points.col(0));
    Contact<kDim> contact = test::contact_at<kDim, 2, kDim - 1>(points);
    constexpr std::uint8_t kAll = (1U << (kDim + 1)) - 1;
    constexpr std::uint8_t kSecondOfRidge = 1U << 3;
    for (const Filter filter : {Filter::None, Filter::Clamp, Filter::Absolute}) {
        contact.active = kAll;
        const StencilMatrix<kDim> both = this->spectrum(points, contact, -1, filter).matrix();
        contact.active = kAll - kSecondOfRidge;
        EXPECT_EQ(both, this->spectrum(points, contact, -1, filter).matrix());
        EXPECT_GT(both.norm(), 0);
        EXPECT_TRUE(both.allFinite());
    }
}

TYPED_TEST(DistanceHessian, WithFlatFacetsStaysFinite) {
    constexpr int kDim = TypeParam::value;
    Stencil<kDim> points = Stencil<kDim>::Zero();  // a facet that has collapsed to an edge
    points.col(0).setConstant(0.3);
    points(0, 2) = 1;
    points.row(0).tail(kDim - 2).setConstant(0.5);
    const Contact<kDim> contact = test::contact_at<kDim, 1, kDim>(points);
    EXPECT_TRUE(this->spectrum(points, contact, -1, Filter::Clamp).matrix().allFinite());
}

}  // namespace
}  // namespace pent::contact
