#include "support/messages.h"

#include <pent/contact/obstacles.h>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace pent::contact {
namespace {

template <typename T>
class ObstaclesTest : public testing::Test {
protected:
    Vector<T::value> random_point(double size) {
        std::uniform_real_distribution<double> coordinate(-size, size);
        return Vector<T::value>::NullaryExpr([&] { return coordinate(random_); });
    }

    std::vector<Obstacle<T::value>> obstacles() {
        const Vector<T::value> center = random_point(0.3);
        const Vector<T::value> up = random_point(1).normalized();
        return {HalfSpace<T::value>{up, 0.2}, Ball<T::value>{center, 0.8},
                Cavity<T::value>{center, 0.9}, Bowl<T::value>{center, 0.9, up}};
    }

    std::mt19937 random_{3};
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(ObstaclesTest, Dimensions);

TYPED_TEST(ObstaclesTest, GradientAndHessianAreCentralDifferences) {
    constexpr int kDim = TypeParam::value;
    int compared = 0;
    for (const auto& obstacle : this->obstacles()) {
        for (int trial = 0; trial < 200; ++trial) {
            const Vector<kDim> x = this->random_point(1.5);
            const double h = 1e-5;
            const Vector<kDim> gradient = signed_distance_gradient<kDim>(obstacle, x);
            const Eigen::Matrix<double, kDim, kDim> hessian =
                signed_distance_hessian<kDim>(obstacle, x);
            if (hessian.norm() > 20) {
                continue;  // next to a center or the rim, where differences do not reach
            }
            Vector<kDim> slope;
            Eigen::Matrix<double, kDim, kDim> change;
            bool is_smooth = true;
            for (int axis = 0; axis < kDim; ++axis) {
                const Vector<kDim> ahead = x + h * Vector<kDim>::Unit(axis);
                const Vector<kDim> behind = x - h * Vector<kDim>::Unit(axis);
                slope[axis] = (signed_distance<kDim>(obstacle, ahead)
                               - signed_distance<kDim>(obstacle, behind))
                              / (2 * h);
                change.col(axis) = (signed_distance_gradient<kDim>(obstacle, ahead)
                                    - signed_distance_gradient<kDim>(obstacle, behind))
                                   / (2 * h);
                // In the ground beside a bowl the nearest surface may change within the step.
                is_smooth = is_smooth && change.col(axis).norm() < 100;
            }
            if (is_smooth) {
                ++compared;
                // Truncation h^2 times third derivatives, which are below 20^2 here.
                EXPECT_LT((slope - gradient).norm(), 1e-7);
                EXPECT_LT((change - hessian).norm(), 1e-5);
            }
        }
    }
    EXPECT_GT(compared, 700);
}

TYPED_TEST(ObstaclesTest, DistanceIsContinuousAndHasSlopeOne) {
    constexpr int kDim = TypeParam::value;
    for (const auto& obstacle : this->obstacles()) {
        for (int trial = 0; trial < 500; ++trial) {
            const Vector<kDim> a = this->random_point(1.5);
            const Vector<kDim> b = a + this->random_point(0.1);
            EXPECT_LE(
                std::abs(signed_distance<kDim>(obstacle, a) - signed_distance<kDim>(obstacle, b)),
                (a - b).norm() * (1 + 1e-12));
            EXPECT_NEAR(signed_distance_gradient<kDim>(obstacle, a).norm(), 1, 1e-14);
            // Going back along the gradient by the distance ends on the surface.
            const Vector<kDim> foot =
                a
                - signed_distance<kDim>(obstacle, a) * signed_distance_gradient<kDim>(obstacle, a);
            EXPECT_NEAR(signed_distance<kDim>(obstacle, foot), 0, 1e-7);
        }
    }
}

TYPED_TEST(ObstaclesTest, ResponseHasDerivativesThatAreCentralDifferences) {
    constexpr int kDim = TypeParam::value;
    const Penalty penalty{0.3, 50, Reach::AnyDepth};
    const double h = 1e-6;
    for (const auto& obstacle : this->obstacles()) {
        for (int trial = 0; trial < 100; ++trial) {
            const Vector<kDim> x = this->random_point(1.5);
            if (signed_distance_hessian<kDim>(obstacle, x).norm() > 20
                || std::abs(signed_distance<kDim>(obstacle, x) - 0.3) < 1e-3) {
                continue;
            }
            const Response<kDim> at = obstacle_response<kDim>(obstacle, x, penalty, Filter::None);
            Vector<kDim> change = Vector<kDim>::Zero();
            const Vector<kDim> along = this->random_point(1).normalized();
            const Response<kDim> ahead =
                obstacle_response<kDim>(obstacle, x + h * along, penalty, Filter::None);
            const Response<kDim> behind =
                obstacle_response<kDim>(obstacle, x - h * along, penalty, Filter::None);
            EXPECT_NEAR((ahead.energy - behind.energy) / (2 * h), at.gradient.dot(along), 1e-5);
            change = (ahead.gradient - behind.gradient) / (2 * h);
            if (change.norm() < 1e5) {  // not across the change of the nearest surface
                EXPECT_LT((change - at.hessian * along).norm(), 1e-2);
            }
        }
    }
}

TYPED_TEST(ObstaclesTest, FilteredHessiansAreThoseOfADenseEigensolver) {
    constexpr int kDim = TypeParam::value;
    using Block = Eigen::Matrix<double, kDim, kDim>;
    const Penalty penalty{0.4, 50, Reach::AnyDepth};
    for (const auto& obstacle : this->obstacles()) {
        for (int trial = 0; trial < 100; ++trial) {
            const Vector<kDim> x = this->random_point(1.5);
            const Block raw = obstacle_response<kDim>(obstacle, x, penalty, Filter::None).hessian;
            const Eigen::SelfAdjointEigenSolver<Block> solver(raw);
            const Block& Q = solver.eigenvectors();
            const Block clamped = Q * solver.eigenvalues().cwiseMax(0).asDiagonal() * Q.transpose();
            const Block absolute = Q * solver.eigenvalues().cwiseAbs().asDiagonal() * Q.transpose();
            const double rounding = 1e-12 * (1 + raw.norm());
            EXPECT_LT(
                (obstacle_response<kDim>(obstacle, x, penalty, Filter::Clamp).hessian - clamped)
                    .norm(),
                rounding);
            EXPECT_LT(
                (obstacle_response<kDim>(obstacle, x, penalty, Filter::Absolute).hessian - absolute)
                    .norm(),
                rounding);
        }
    }
}

TYPED_TEST(ObstaclesTest, AreFiniteAtTheirCenters) {
    constexpr int kDim = TypeParam::value;
    const Vector<kDim> center = this->random_point(1);
    const Vector<kDim> up = Vector<kDim>::UnitY();
    const std::vector<Obstacle<kDim>> obstacles{Ball<kDim>{center, 1}, Cavity<kDim>{center, 1},
                                                Bowl<kDim>{center, 1, up}};
    for (const auto& obstacle : obstacles) {
        for (const double above : {0.0, 0.5}) {
            const Vector<kDim> x = center + above * up;
            EXPECT_TRUE(std::isfinite(signed_distance<kDim>(obstacle, x)));
            EXPECT_NEAR(signed_distance_gradient<kDim>(obstacle, x).norm(), 1, 1e-14);
            EXPECT_TRUE(signed_distance_hessian<kDim>(obstacle, x).allFinite());
        }
    }
}

TYPED_TEST(ObstaclesTest, ThatMakeNoSenseAreRefused) {
    constexpr int kDim = TypeParam::value;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Vector<kDim> zero = Vector<kDim>::Zero();
    const std::vector<std::pair<Obstacle<kDim>, std::string>> wrong{
        {HalfSpace<kDim>{zero, 0}, "unit length"},
        {HalfSpace<kDim>{Vector<kDim>::UnitX(), nan}, "offset"},
        {Ball<kDim>{zero, 0}, "radius"},
        {Cavity<kDim>{Vector<kDim>::Constant(nan), 1}, "center"},
        {Bowl<kDim>{zero, 1, zero}, "up"}};
    for (const auto& [obstacle, part] : wrong) {
        const std::string message =
            pent::test::error_of([&, &shape = obstacle] { check<kDim>(shape, "obstacle 3"); });
        pent::test::expect_contains(message, {"obstacle 3: ", part});
    }
    EXPECT_NO_THROW(check<kDim>(HalfSpace<kDim>{Vector<kDim>::UnitX(), 0}, "obstacle"));
}

TEST(Bowl, IsHollowHalfABallInTheGround) {
    const Bowl<4> bowl{Vector<4>::Zero(), 6, Vector<4>::UnitY()};
    const auto distance = [&](const Vector<4>& x) { return signed_distance<4>(bowl, x); };
    EXPECT_DOUBLE_EQ(distance({0, -4, 0, 0}), 2);   // above its bottom
    EXPECT_DOUBLE_EQ(distance({0, -7, 0, 0}), -1);  // in the ground below
    EXPECT_DOUBLE_EQ(distance({0, 0, 5, 0}), 1);    // level with the rim
    EXPECT_DOUBLE_EQ(distance({3, 4, 0, 0}), 5);    // above: 3 inside the rim, 4 up
    EXPECT_DOUBLE_EQ(distance({0, 2, 0, 9}), 2);    // over the ground beside
    EXPECT_DOUBLE_EQ(distance({0, -1, 0, 9}), -1);  // in the ground beside
    EXPECT_DOUBLE_EQ(distance({0, -5, 0, 6}), std::min(6 - std::sqrt(61.0), 0.0));
}

}  // namespace
}  // namespace pent::contact
