#include "normals.h"
#include "support/messages.h"

#include <pent/contact/obstacles.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <type_traits>

namespace pent::contact {
namespace {

template <typename T>
class ObstaclesTest : public testing::Test {
protected:
    Vector<T::value> random_point(double size) {
        std::uniform_real_distribution<double> coordinate(-size, size);
        return Vector<T::value>::NullaryExpr([&] { return coordinate(random_); });
    }

    std::vector<ObstacleShape<T::value>> obstacles() {
        const Vector<T::value> center = random_point(0.3);
        const Vector<T::value> up = random_point(1).normalized();
        return {HalfSpace<T::value>{up, 0.2},
                Ball<T::value>{center, 0.8},
                Cavity<T::value>{center, 0.9},
                Bowl<T::value>{center, 0.9, up},
                Cuboid<T::value>{center, Vector<T::value>::LinSpaced(0.7, 1.3)},
                Cuboid<T::value>{center, Vector<T::value>::LinSpaced(0.7, 1.3), random_axes()}};
    }

    Block<T::value> random_axes() {
        Block<T::value> columns;
        for (int axis = 0; axis < T::value; ++axis) {
            columns.col(axis) = random_point(1);
        }
        Block<T::value> axes = columns.householderQr().householderQ();
        axes.col(0) *= axes.determinant() < 0 ? -1 : 1;
        return axes;
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
            const Vector<kDim> gradient = signed_distance<kDim>(obstacle, x).gradient;
            const Eigen::Matrix<double, kDim, kDim> hessian =
                signed_distance<kDim>(obstacle, x).hessian();
            if (hessian.norm() > 20) {
                continue;  // next to a center or the rim, where differences do not reach
            }
            Vector<kDim> slope;
            Eigen::Matrix<double, kDim, kDim> change;
            bool is_smooth = true;
            for (int axis = 0; axis < kDim; ++axis) {
                const Vector<kDim> ahead = x + h * Vector<kDim>::Unit(axis);
                const Vector<kDim> behind = x - h * Vector<kDim>::Unit(axis);
                slope[axis] = (signed_distance<kDim>(obstacle, ahead).value
                               - signed_distance<kDim>(obstacle, behind).value)
                              / (2 * h);
                change.col(axis) = (signed_distance<kDim>(obstacle, ahead).gradient
                                    - signed_distance<kDim>(obstacle, behind).gradient)
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
            EXPECT_LE(std::abs(signed_distance<kDim>(obstacle, a).value
                               - signed_distance<kDim>(obstacle, b).value),
                      (a - b).norm() * (1 + 1e-12));
            EXPECT_NEAR(signed_distance<kDim>(obstacle, a).gradient.norm(), 1, 1e-14);
            // Going back along the gradient by the distance ends on the surface.
            const Vector<kDim> foot = a
                                      - signed_distance<kDim>(obstacle, a).value
                                            * signed_distance<kDim>(obstacle, a).gradient;
            EXPECT_NEAR(signed_distance<kDim>(obstacle, foot).value, 0, 1e-7);
        }
    }
}

// Beside sampling the way densely; ways that are deeper than asked by less than an eighth may be
// overlooked, and are not judged.
TYPED_TEST(ObstaclesTest, ArePassedThroughByWaysThatGoDeepAndComeOutAgain) {
    constexpr int kDim = TypeParam::value;
    constexpr double kDepth = 0.05;
    constexpr int kSamples = 4000;
    std::array<int, 2> found{};
    for (const auto& obstacle : this->obstacles()) {
        for (int trial = 0; trial < 300; ++trial) {
            const Vector<kDim> from = this->random_point(2);
            const Vector<kDim> to = this->random_point(2);
            const auto height = [&](double t) {
                return signed_distance<kDim>(obstacle, from + t * (to - from)).value;
            };
            double lowest = std::numeric_limits<double>::infinity();
            for (int i = 0; i <= kSamples; ++i) {
                lowest = std::min(lowest, height(static_cast<double>(i) / kSamples));
            }
            if (lowest < -kDepth && lowest > -1.13 * kDepth) {
                continue;
            }
            const bool is_passed =
                std::min(height(0), height(1)) > -kDepth && lowest <= -1.13 * kDepth;
            EXPECT_EQ(passes_through<kDim>(obstacle, from, to, kDepth), is_passed) << lowest;
            ++found[is_passed ? 1 : 0];
        }
    }
    EXPECT_GT(found[0], 300);
    EXPECT_GT(found[1], 30);
    // Half-spaces and hollow balls have no far side.
    const auto all = this->obstacles();
    for (int trial = 0; trial < 300; ++trial) {
        const Vector<kDim> from = this->random_point(5);
        const Vector<kDim> to = this->random_point(5);
        EXPECT_FALSE(passes_through<kDim>(all[0], from, to, kDepth));
        EXPECT_FALSE(passes_through<kDim>(all[2], from, to, kDepth));
    }
}

TYPED_TEST(ObstaclesTest, ThatAreTurnedBoxesAreAsFarAsTheBoxFromThePointTurnedBack) {
    constexpr int kDim = TypeParam::value;
    const Vector<kDim> sides = Vector<kDim>::LinSpaced(0.7, 1.3);
    const Vector<kDim> center = this->random_point(1);
    const Block<kDim> axes = this->random_axes();
    const Cuboid<kDim> straight{Vector<kDim>::Zero(), sides};
    const Cuboid<kDim> turned{center, sides, axes};
    for (int trial = 0; trial < 500; ++trial) {
        const Vector<kDim> x = this->random_point(1.2);
        const auto before = signed_distance<kDim>(straight, x);
        const auto after = signed_distance<kDim>(turned, center + axes * x);
        EXPECT_NEAR(after.value, before.value, 1e-14);
        EXPECT_LT((after.gradient - axes * before.gradient).norm(), 1e-13);
    }
    const ObstacleCore<kDim> core = core_of<kDim>(turned);
    EXPECT_LT(
        ((axes.transpose() * (core.points.colwise() - center)).cwiseAbs().colwise() - 0.5 * sides)
            .cwiseAbs()
            .maxCoeff(),
        1e-14);
}

TYPED_TEST(ObstaclesTest, AreFiniteAtTheirCenters) {
    constexpr int kDim = TypeParam::value;
    const Vector<kDim> center = this->random_point(1);
    const Vector<kDim> up = Vector<kDim>::UnitY();
    const std::vector<ObstacleShape<kDim>> obstacles{Ball<kDim>{center, 1}, Cavity<kDim>{center, 1},
                                                     Bowl<kDim>{center, 1, up}};
    for (const auto& obstacle : obstacles) {
        for (const double above : {0.0, 0.5}) {
            const Vector<kDim> x = center + above * up;
            EXPECT_TRUE(std::isfinite(signed_distance<kDim>(obstacle, x).value));
            EXPECT_NEAR(signed_distance<kDim>(obstacle, x).gradient.norm(), 1, 1e-14);
            EXPECT_TRUE(signed_distance<kDim>(obstacle, x).hessian().allFinite());
        }
    }
}

// There all of its rim is as near; which point of it is taken does not matter.
TYPED_TEST(ObstaclesTest, ThatAreBowlsAreAsFarAsTheirRimsFromWhatIsAboveTheirMiddle) {
    constexpr int kDim = TypeParam::value;
    for (int trial = 0; trial < 20; ++trial) {
        const Bowl<kDim> bowl{this->random_point(1), 1.2, this->random_point(1).normalized()};
        const auto above = signed_distance<kDim>(bowl, bowl.center + Vector<kDim>(0.5 * bowl.up));
        EXPECT_NEAR(above.value, 1.3, 1e-14);  // 0.5, 1.2, 1.3
        EXPECT_NEAR(above.gradient.norm(), 1, 1e-14);
        EXPECT_NEAR(above.gradient.dot(bowl.up), 0.5 / 1.3, 1e-14);
    }
}

TYPED_TEST(ObstaclesTest, ThatMakeNoSenseAreRefused) {
    constexpr int kDim = TypeParam::value;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Vector<kDim> zero = Vector<kDim>::Zero();
    const Vector<kDim> one = Vector<kDim>::Ones();
    Block<kDim> mirror = Block<kDim>::Identity();
    mirror(0, 0) = kDim == 3 ? 1 : -1;  // an odd number of axes against their directions
    const std::vector<std::pair<ObstacleShape<kDim>, std::vector<std::string>>> wrong{
        {HalfSpace<kDim>{zero, 0}, {"normal", "length 1"}},
        {HalfSpace<kDim>{Vector<kDim>::UnitX(), nan}, {"offset", "finite"}},
        {Ball<kDim>{zero, 0}, {"radius", "above 0"}},
        {Cavity<kDim>{Vector<kDim>::Constant(nan), 1}, {"center", "finite numbers"}},
        {Bowl<kDim>{zero, 1, zero}, {"up", "length 1"}},
        {Cuboid<kDim>{zero, zero}, {"sides", "above 0"}},
        {Cuboid<kDim>{zero, one, 1.01 * Block<kDim>::Identity()}, {"axes", "unit vectors"}},
        {Cuboid<kDim>{zero, one, -mirror}, {"axes", "across one another"}}};
    for (const auto& [obstacle, parts] : wrong) {
        const std::string message = pent::test::error_of(
            [&, &shape = obstacle] { pent::check<kDim>(shape, kDim, "obstacle 3"); });
        pent::test::expect_contains(message, {"obstacle 3: ", parts[0], parts[1]});
    }
    EXPECT_NO_THROW(pent::check<kDim>(HalfSpace<kDim>{Vector<kDim>::UnitX(), 0}, kDim, "obstacle"));
}

// As a scene has them, whose dimension is not known when it is compiled.
TYPED_TEST(ObstaclesTest, OfAnyDimensionBecomeThoseOfOne) {
    constexpr int kDim = TypeParam::value;
    const Vector<kDim> x = this->random_point(1);
    std::size_t shapes = 0;
    for (ObstacleShape<Eigen::Dynamic> shape : all_shapes(kDim)) {
        double number = 0.3;
        std::visit(
            [&](auto& one) {
                one.fields(one, [&](const char* /*name*/, auto& value, ShapeField kind) {
                    using Value = std::remove_cvref_t<decltype(value)>;
                    if constexpr (std::is_same_v<Value, double>) {
                        value = number;
                    } else if constexpr (std::is_same_v<Value, Eigen::MatrixXd>) {
                        EXPECT_TRUE(value.isIdentity(0));
                    } else if (kind == ShapeField::Direction) {
                        value[2] = 1;
                    } else if (kind != ShapeField::UpDirection) {
                        value.setConstant(number);
                    }
                    number += 0.1;
                });
            },
            shape);
        pent::check<Eigen::Dynamic>(shape, kDim, "obstacle");
        pent::test::expect_contains(
            pent::test::error_of([&] { pent::check<Eigen::Dynamic>(shape, 7 - kDim, "obstacle"); }),
            {"finite numbers"});
        const ObstacleShape<kDim> fixed = fixed_size<kDim>(shape);
        EXPECT_EQ(fixed.index(), shapes++);
        if (const auto* ball = std::get_if<Ball<kDim>>(&fixed)) {
            EXPECT_EQ(ball->center, Vector<kDim>::Constant(0.3));
            EXPECT_EQ(ball->radius, 0.4);
        }
        if (const auto* bowl = std::get_if<Bowl<kDim>>(&fixed)) {
            EXPECT_EQ(bowl->up, Vector<kDim>::Unit(1));
        }
        EXPECT_TRUE(std::isfinite(signed_distance<kDim>(fixed, x).value));
    }
    EXPECT_EQ(shapes, std::variant_size_v<ObstacleShape<kDim>>);
}

// Those that repel facets: the distance to the core, less its radius, is that to the surface.
TYPED_TEST(ObstaclesTest, CoresAreWhereTheDistanceSays) {
    constexpr int kDim = TypeParam::value;
    for (const auto& obstacle : this->obstacles()) {
        const ObstacleCore<kDim> core = core_of<kDim>(obstacle);
        EXPECT_EQ(core.points.cols() > 0, repels(obstacle) == Repels::Facets);
        for (Eigen::Index i = 0; i < core.points.cols(); ++i) {
            EXPECT_NEAR(signed_distance<kDim>(obstacle, core.points.col(i)).value, -core.radius,
                        1e-15);
        }
        for (Eigen::Index f = 0; f < core.surface.facets.cols(); ++f) {
            Vector<kDim> middle = Vector<kDim>::Zero();
            Corners<kDim, kDim> corners;
            for (int i = 0; i < kDim; ++i) {
                corners.col(i) = core.points.col(core.surface.facets(i, f));
                middle += corners.col(i) / kDim;
            }
            const SignedDistance<kDim> at = signed_distance<kDim>(obstacle, middle);
            EXPECT_NEAR(at.value, -core.radius, 1e-15);
            const Vector<kDim> outward = facet_normal<kDim>(corners).normalized();
            EXPECT_GT(signed_distance<kDim>(obstacle, middle + 0.01 * outward).value, 0.009);
        }
    }
}

TEST(Bowl, IsHollowHalfABallInTheGround) {
    const Bowl<4> bowl{Vector<4>::Zero(), 6, Vector<4>::UnitY()};
    const auto distance = [&](const Vector<4>& x) { return signed_distance<4>(bowl, x).value; };
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
