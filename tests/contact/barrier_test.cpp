#include <pent/contact/barrier.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>

namespace pent::contact {
namespace {

constexpr double kHuge = std::numeric_limits<double>::infinity();

TEST(Barrier, IsNothingFromFarAndGrowsWithoutBound) {
    const Barrier barrier{.distance = 0.1, .stiffness = 50, .separation = 0.02};
    EXPECT_EQ(barrier_energy(0.1201, barrier), 0);
    EXPECT_EQ(barrier_slope(0.3, barrier), 0);
    EXPECT_EQ(barrier_curvature(0.3, barrier), 0);
    double last = 0;
    for (double gap = 0.09; gap > 1e-9; gap /= 2) {
        const double energy = barrier_energy(0.02 + gap, barrier);
        EXPECT_GT(energy, last);
        EXPECT_LT(barrier_slope(0.02 + gap, barrier), 0);
        EXPECT_GT(barrier_curvature(0.02 + gap, barrier), 0);
        last = energy;
    }
    EXPECT_EQ(barrier_energy(0.02, barrier), kHuge);
    EXPECT_EQ(barrier_energy(0.01, barrier), kHuge);
}

TEST(Barrier, HasTheValueWorkedByHandAtHalfItsDistance) {
    // y = 1/4: -50 * 0.01 * (9/16) ln(1/4).
    EXPECT_NEAR(barrier_energy(0.05, {0.1, 50, 0}), 0.5 * 9 / 16 * std::log(4), 1e-15);
}

TEST(Barrier, HasDerivativesThatAreCentralDifferences) {
    const Barrier barrier{.distance = 0.1, .stiffness = 50, .separation = 0.02};
    for (double gap = 1e-4; gap < 0.0999; gap *= 1.3) {
        const double h = 1e-4 * gap;
        const double d = 0.02 + gap;
        const double slope =
            (barrier_energy(d + h, barrier) - barrier_energy(d - h, barrier)) / (2 * h);
        const double curvature =
            (barrier_slope(d + h, barrier) - barrier_slope(d - h, barrier)) / (2 * h);
        // Truncation (h / gap)^2 = 1e-8 of the value; rounding 1e-16 energy / h.
        EXPECT_NEAR(barrier_slope(d, barrier), slope, 1e-6 * std::abs(slope) + 1e-9);
        EXPECT_NEAR(barrier_curvature(d, barrier), curvature, 1e-6 * std::abs(curvature) + 1e-6);
    }
    // Twice continuously differentiable where it ends.
    EXPECT_NEAR(barrier_curvature(0.12 - 1e-9, barrier), 0, 1e-4);
}

template <typename T>
class PairBarrierTest : public testing::Test {
protected:
    static constexpr int kSpace = T::value;

    template <int Count>
    Corners<kSpace, Count> corners() {
        return Corners<kSpace, Count>::NullaryExpr([&] { return coordinate_(random_); });
    }

    template <int K, int L>
    static Stencil<kSpace> stencil(const Corners<kSpace, K>& a, const Corners<kSpace, L>& b) {
        Stencil<kSpace> points;
        points << a, b;
        return points;
    }

    template <int K, int L>
    static NearestFaces<kSpace> faces_at(const Stencil<kSpace>& points) {
        return nearest_faces<kSpace, K, L>(closest_points<kSpace, K, L>(
            points.template leftCols<K>(), points.template rightCols<L>()));
    }

    template <int K, int L>
    static double energy_at(const Stencil<kSpace>& points,
                            const Barrier& barrier,
                            const Mollifier& m) {
        return pair_barrier_energy<kSpace>(points, faces_at<K, L>(points), barrier, m);
    }

    template <int K, int L>
    static StencilVector<kSpace> gradient_at(const Stencil<kSpace>& points,
                                             const Barrier& barrier,
                                             const Mollifier& m) {
        return pair_barrier_gradient<kSpace>(points, faces_at<K, L>(points), barrier, m);
    }

    static Stencil<kSpace> moved(const Stencil<kSpace>& points, int i, double h) {
        Stencil<kSpace> result = points;
        result.data()[i] += h;
        return result;
    }

    // Derivatives against differences of the energy at the true distance, which knows nothing of faces.
    template <int K, int L>
    void expect_derivatives(const Stencil<kSpace>& points,
                            const Barrier& barrier,
                            const Mollifier& m) {
        const NearestFaces<kSpace> faces = faces_at<K, L>(points);
        const StencilVector<kSpace> gradient = gradient_at<K, L>(points, barrier, m);
        const StencilMatrix<kSpace> hessian =
            pair_barrier_hessian<kSpace>(points, faces, barrier, m, Filter::None);
        const double h = 1e-6;
        const double size = 1e-6 * (gradient.norm() + hessian.norm());  // truncation, and rounding
        for (int i = 0; i < gradient.size(); ++i) {
            const Stencil<kSpace> plus = moved(points, i, h);
            const Stencil<kSpace> minus = moved(points, i, -h);
            if (faces_at<K, L>(plus).active != faces.active
                || faces_at<K, L>(minus).active != faces.active) {
                return;  // on the border of a stratum, where the Hessian jumps
            }
            EXPECT_NEAR(
                gradient[i],
                (energy_at<K, L>(plus, barrier, m) - energy_at<K, L>(minus, barrier, m)) / (2 * h),
                size);
            const StencilVector<kSpace> column =
                (gradient_at<K, L>(plus, barrier, m) - gradient_at<K, L>(minus, barrier, m))
                / (2 * h);
            EXPECT_LT((hessian.col(i) - column).norm(), 10 * size) << "coordinate " << i;
        }
        ++checked_[faces.active];
    }

    std::mt19937 random_{3};
    std::uniform_real_distribution<double> coordinate_{-1, 1};
    std::map<int, int> checked_;  // cases by stratum
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(PairBarrierTest, Dimensions);

TYPED_TEST(PairBarrierTest, HasTheDerivativesOfTheTrueDistanceInEveryStratum) {
    constexpr int kDim = TypeParam::value;
    for (int k = 0; k < 1500; ++k) {
        const Stencil<kDim> points = this->template stencil<1, kDim>(
            this->template corners<1>(), this->template corners<kDim>());
        const double d = this->template faces_at<1, kDim>(points).distance;
        if (d > 0.05) {
            this->template expect_derivatives<1, kDim>(points, {1.5 * d, 1, 0.1 * d}, {});
        }
    }
    EXPECT_EQ(this->checked_.size(), (1U << kDim) - 1);  // every face of the facet
    this->checked_.clear();
    for (int k = 0; k < 4000; ++k) {
        const Stencil<kDim> points = this->template stencil<2, kDim - 1>(
            this->template corners<2>(), this->template corners<kDim - 1>());
        const double d = this->template faces_at<2, kDim - 1>(points).distance;
        if (d > 0.01) {
            this->template expect_derivatives<2, kDim - 1>(points, {1.5 * d, 1, 0}, {});
        }
    }
    EXPECT_EQ(this->checked_.size(), 3 * ((1U << (kDim - 1)) - 1));
}

TYPED_TEST(PairBarrierTest, HasTheDerivativesOfItsProductWithTheMollifier) {
    constexpr int kDim = TypeParam::value;
    for (int k = 0; k < 100; ++k) {
        const Stencil<kDim> points = this->template stencil<2, kDim - 1>(
            this->template corners<2>(), this->template corners<kDim - 1>());
        const double d = this->template faces_at<2, kDim - 1>(points).distance;
        const double c = spanned_volume_squared<kDim>(points);
        if (d > 0.05 && c > 0.01) {
            this->template expect_derivatives<2, kDim - 1>(points, {1.5 * d, 1, 0}, {1.7 * c});
            this->template expect_derivatives<2, kDim - 1>(points, {1.5 * d, 1, 0}, {0.9 * c});
        }
    }
    EXPECT_GT(this->checked_.size(), 3U);
}

TYPED_TEST(PairBarrierTest, FilterIsTheOneOnAllEigenvalues) {
    constexpr int kDim = TypeParam::value;
    const auto expect = [&](const Stencil<kDim>& points, const NearestFaces<kDim>& faces,
                            const Mollifier& m) {
        const Barrier barrier{1.5 * faces.distance, 1, 0};
        const StencilMatrix<kDim> exact =
            pair_barrier_hessian<kDim>(points, faces, barrier, m, Filter::None);
        const Eigen::SelfAdjointEigenSolver<StencilMatrix<kDim>> solver(exact);
        const auto& V = solver.eigenvectors();
        const StencilMatrix<kDim> clamped =
            V * solver.eigenvalues().cwiseMax(0).asDiagonal() * V.transpose();
        const StencilMatrix<kDim> absolute =
            V * solver.eigenvalues().cwiseAbs().asDiagonal() * V.transpose();
        const double rounding = 1e-10 * exact.norm();
        EXPECT_LT(
            (pair_barrier_hessian<kDim>(points, faces, barrier, m, Filter::Clamp) - clamped).norm(),
            rounding);
        EXPECT_LT(
            (pair_barrier_hessian<kDim>(points, faces, barrier, m, Filter::Absolute) - absolute)
                .norm(),
            rounding);
    };
    for (int k = 0; k < 50; ++k) {
        const Stencil<kDim> point = this->template stencil<1, kDim>(this->template corners<1>(),
                                                                    this->template corners<kDim>());
        expect(point, this->template faces_at<1, kDim>(point), {});
        const Stencil<kDim> mixed = this->template stencil<2, kDim - 1>(
            this->template corners<2>(), this->template corners<kDim - 1>());
        expect(mixed, this->template faces_at<2, kDim - 1>(mixed), {});
        expect(mixed, this->template faces_at<2, kDim - 1>(mixed),
               {2 * spanned_volume_squared<kDim>(mixed)});
    }
}

// The weights cannot be told to move along an edge of one face and a parallel one of the other.
TYPED_TEST(PairBarrierTest, HessianOfParallelEdgesIsThatWithOneOfThem) {
    constexpr int kDim = TypeParam::value;
    const Corners<kDim, 2> edge = this->template corners<2>();
    Corners<kDim, kDim - 1> ridge = this->template corners<kDim - 1>();
    ridge.col(1) = ridge.col(0) + 0.7 * (edge.col(1) - edge.col(0));
    const Stencil<kDim> points = this->template stencil<2, kDim - 1>(edge, ridge);
    NearestFaces<kDim> faces = this->template faces_at<2, kDim - 1>(points);
    const Barrier barrier{1.5 * faces.distance, 1, 0};
    constexpr std::uint8_t kAll = (1U << (kDim + 1)) - 1;
    constexpr std::uint8_t kSecondOfRidge = 1U << 3;
    for (const Filter filter : {Filter::None, Filter::Clamp, Filter::Absolute}) {
        faces.active = kAll;
        const StencilMatrix<kDim> both =
            pair_barrier_hessian<kDim>(points, faces, barrier, {}, filter);
        faces.active = kAll - kSecondOfRidge;
        EXPECT_EQ(both, pair_barrier_hessian<kDim>(points, faces, barrier, {}, filter));
        EXPECT_GT(both.norm(), 0);
        EXPECT_TRUE(both.allFinite());
    }
}

TYPED_TEST(PairBarrierTest, ForceIsContinuousWhereTheNearestFaceChanges) {
    constexpr int kDim = TypeParam::value;
    // A point that walks over a facet and beyond all its borders.
    Corners<kDim, kDim> facet = Corners<kDim, kDim>::Zero();
    for (int i = 1; i < kDim; ++i) {
        facet(i - 1, i) = 1;
    }
    const Barrier barrier{1, 1, 0};
    Corners<kDim, 1> point = Corners<kDim, 1>::Constant(0.21);
    point[kDim - 1] = 0.3;
    StencilVector<kDim> last;
    for (int k = 0; k <= 20'000; ++k) {
        point[0] = -0.8 + 1e-4 * k;
        const Stencil<kDim> points = this->template stencil<1, kDim>(point, facet);
        const StencilVector<kDim> gradient =
            this->template gradient_at<1, kDim>(points, barrier, {});
        if (k > 0) {
            EXPECT_LT((gradient - last).norm(), 0.02) << "at " << point[0];  // 1e-4 |Hessian|
        }
        last = gradient;
    }
}

TYPED_TEST(PairBarrierTest, ForceIsContinuousWhereAMixedPairTurnsParallel) {
    constexpr int kDim = TypeParam::value;
    // An edge above a ridge, turned through the directions of the ridge: its closest point jumps from
    // one end to the other, with a force that the mollifier has taken away.
    Corners<kDim, kDim - 1> ridge = Corners<kDim, kDim - 1>::Zero();
    for (int i = 1; i < kDim - 1; ++i) {
        ridge(i - 1, i) = 4;
    }
    ridge.row(0).array() -= 1;
    const Barrier barrier{0.5, 1, 0};
    const auto at = [&](double angle, bool is_mollified) {
        Corners<kDim, 2> edge = Corners<kDim, 2>::Constant(0.25);
        edge.row(kDim - 1).setConstant(0.2);
        edge(0, 1) += std::cos(angle);
        edge(kDim - 1, 1) += std::sin(angle);
        edge(kDim - 2, 0) = 0;
        edge(kDim - 2, 1) = 1e-3;
        const Stencil<kDim> points = this->template stencil<2, kDim - 1>(edge, ridge);
        return this->template gradient_at<2, kDim - 1>(
            points, barrier, {is_mollified ? 1e-3 * std::pow(4, 2 * (kDim - 2)) : 0});
    };
    // The largest change of the force between two angles that are h apart.
    const auto jump = [&](bool is_mollified, double h) {
        double largest = 0;
        for (int k = -5000; k < 5000; ++k) {
            largest =
                std::max(largest, (at((k + 1) * h, is_mollified) - at(k * h, is_mollified)).norm());
        }
        return largest;
    };
    EXPECT_GT(jump(false, 1e-6), 0.3);
    EXPECT_LT(jump(true, 1e-6), 0.01);
    EXPECT_LT(jump(true, 1e-8), 0.0001);
}

TYPED_TEST(PairBarrierTest, HessianWithFlatFacetsStaysFinite) {
    constexpr int kDim = TypeParam::value;
    Corners<kDim, kDim> facet = Corners<kDim, kDim>::Zero();  // collapsed to an edge
    facet(0, 1) = 1;
    facet.row(0).tail(kDim - 2).setConstant(0.5);
    Corners<kDim, 1> point = Corners<kDim, 1>::Constant(0.3);
    const Stencil<kDim> points = this->template stencil<1, kDim>(point, facet);
    const NearestFaces<kDim> faces = this->template faces_at<1, kDim>(points);
    EXPECT_TRUE(
        pair_barrier_hessian<kDim>(points, faces, {1, 1, 0}, {}, Filter::Clamp).allFinite());
}

template <typename T>
class SpannedVolumeTest : public PairBarrierTest<T> {};
TYPED_TEST_SUITE(SpannedVolumeTest, Dimensions);

TYPED_TEST(SpannedVolumeTest, IsTheGramDeterminantOfTheEdges) {
    constexpr int kDim = TypeParam::value;
    for (int k = 0; k < 20; ++k) {
        const Stencil<kDim> v = this->template corners<kDim + 1>();
        Eigen::Matrix<double, kDim, kDim - 1> edges;
        edges.col(0) = v.col(1) - v.col(0);
        for (int i = 1; i < kDim - 1; ++i) {
            edges.col(i) = v.col(2 + i) - v.col(2);
        }
        EXPECT_NEAR(spanned_volume_squared<kDim>(v), (edges.transpose() * edges).determinant(),
                    1e-12);
    }
}

TYPED_TEST(SpannedVolumeTest, IsZeroWhereTheEdgeHasADirectionOfTheRidge) {
    constexpr int kDim = TypeParam::value;
    Stencil<kDim> v = this->template corners<kDim + 1>();
    v.col(1) = v.col(0) + 0.7 * (v.col(kDim) - v.col(2));
    EXPECT_NEAR(spanned_volume_squared<kDim>(v), 0, 1e-28);
    EXPECT_NEAR(spanned_volume_squared_gradient<kDim>(v).norm(), 0, 1e-13);  // a minimum
}

TYPED_TEST(SpannedVolumeTest, HasDerivativesThatAreCentralDifferences) {
    constexpr int kDim = TypeParam::value;
    const double h = 1e-5;
    for (int k = 0; k < 20; ++k) {
        const Stencil<kDim> v = this->template corners<kDim + 1>();
        const StencilVector<kDim> gradient = spanned_volume_squared_gradient<kDim>(v);
        const StencilMatrix<kDim> hessian = spanned_volume_squared_hessian<kDim>(v);
        for (int i = 0; i < gradient.size(); ++i) {
            const Stencil<kDim> plus = this->moved(v, i, h);
            const Stencil<kDim> minus = this->moved(v, i, -h);
            // A polynomial of degree 6 in coordinates of size 1: truncation h^2 = 1e-10 times 100.
            EXPECT_NEAR(gradient[i],
                        (spanned_volume_squared<kDim>(plus) - spanned_volume_squared<kDim>(minus))
                            / (2 * h),
                        1e-7);
            EXPECT_LT((hessian.col(i)
                       - (spanned_volume_squared_gradient<kDim>(plus)
                          - spanned_volume_squared_gradient<kDim>(minus))
                             / (2 * h))
                          .norm(),
                      1e-6);
        }
    }
}

}  // namespace
}  // namespace pent::contact
