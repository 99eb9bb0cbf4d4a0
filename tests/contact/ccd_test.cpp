#include "ccd.h"

#include "closest_points_oracle.h"
#include "support/crossing_checker.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pent::contact {
namespace {

template <typename T>
class CcdTest : public testing::Test {
protected:
    static constexpr int kSpace = T::value;

    template <int Count>
    Corners<kSpace, Count> corners(double size = 1) {
        return Corners<kSpace, Count>::NullaryExpr([&] { return size * coordinate_(random_); });
    }

    // A facet in the hyperplane where the last coordinate is 0, around the origin.
    static Corners<kSpace, kSpace> level_facet() {
        Corners<kSpace, kSpace> facet = Corners<kSpace, kSpace>::Constant(-1);
        for (int i = 1; i < kSpace; ++i) {
            facet(i - 1, i) = 3 * kSpace;
        }
        facet.row(kSpace - 1).setZero();
        return facet;
    }

    // What must hold of a fraction t: nowhere on the way the gap is below what has to be kept.
    template <int K, int L>
    void expect_safe(const Corners<kSpace, K>& a,
                     const Corners<kSpace, K>& va,
                     const Corners<kSpace, L>& b,
                     const Corners<kSpace, L>& vb,
                     const Clearance& clearance) {
        const auto gap = [&](double t) {
            return std::sqrt(
                       test::closest_points<kSpace, K, L>(a + t * va, b + t * vb).distance_squared)
                   - clearance.separation;
        };
        const double t = safe_fraction<kSpace, K, L>(a, va, b, vb, clearance);
        const double near = std::min(gap(0), clearance.distance);
        constexpr int kSamples = 100;
        for (int k = 0; k <= kSamples; ++k) {
            // Rounding: the distance of simplices of size 1.
            ASSERT_GE(gap(t * k / kSamples), kGapKept * near - 1e-13);
        }
        if (t < 1) {  // it went as far as it had to
            EXPECT_LE(gap(t), 2.0001 * kGapKept * near);
            ++stopped_;
        }
    }

    // Two simplices that touch in their insides, moved apart by a gap and then by some gaps anyhow.
    template <int K, int L>
    void expect_no_passage(double gap) {
        Corners<kSpace, K> a = corners<K>();
        Corners<kSpace, L> b = corners<L>();
        const auto inside = [&](const auto& all) -> Vector<kSpace> {
            Eigen::VectorXd weights = Eigen::VectorXd::NullaryExpr(
                all.cols(), [&] { return 1.2 + coordinate_(random_); });
            return all * (weights / weights.sum());
        };
        b.colwise() += inside(a) - inside(b);
        Eigen::Matrix<double, kSpace - 1, kSpace> edges;
        for (int i = 1; i < K; ++i) {
            edges.row(i - 1) = a.col(i) - a.col(0);
        }
        for (int j = 1; j < L; ++j) {
            edges.row(K + j - 2) = b.col(j) - b.col(0);
        }
        const Eigen::FullPivLU<Eigen::Matrix<double, kSpace - 1, kSpace>> factors(edges);
        b.colwise() += gap * factors.kernel().col(0).normalized();
        const Corners<kSpace, K> va = corners<K>(5 * gap);
        const Corners<kSpace, L> vb = corners<L>(5 * gap);
        const double t = safe_fraction<kSpace, K, L>(a, va, b, vb);
        using Real = pent::test::Real;
        const auto real = [](const auto& all) { return all.template cast<Real>().eval(); };
        const auto end = [&](const auto& all, const auto& motion) {
            return (real(all) + static_cast<Real>(t) * real(motion)).eval();
        };
        EXPECT_FALSE((pent::test::do_meet<kSpace, K, L>(real(a), end(a, va), real(b), end(b, vb))))
            << "gap " << gap << ", t " << t;
        stopped_ += t < 1 ? 1 : 0;
    }

    std::mt19937 random_{17};
    std::uniform_real_distribution<double> coordinate_{-1, 1};
    int stopped_ = 0;
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(CcdTest, Dimensions);

TYPED_TEST(CcdTest, NeverLetsTheGapFallBelowATenth) {
    constexpr int kDim = TypeParam::value;
    for (int k = 0; k < 1000; ++k) {
        const double speed = std::pow(10.0, k % 5 - 2);
        const Clearance clearance{k % 3 == 0 ? 1e-3 : 0, k % 2 == 0 ? 0.05 : 1e300};
        this->template expect_safe<1, kDim>(
            this->template corners<1>(), this->template corners<1>(speed),
            this->template corners<kDim>(), this->template corners<kDim>(speed), clearance);
        this->template expect_safe<2, kDim - 1>(
            this->template corners<2>(), this->template corners<2>(speed),
            this->template corners<kDim - 1>(), this->template corners<kDim - 1>(speed), clearance);
    }
    EXPECT_GT(this->stopped_, 20);  // the test is about something
}

TYPED_TEST(CcdTest, StopsAPointThatFallsStraightDownWhereItShould) {
    constexpr int kDim = TypeParam::value;
    const Corners<kDim, kDim> facet = this->level_facet();
    Corners<kDim, 1> point = Corners<kDim, 1>::Constant(0.1);
    point[kDim - 1] = 1;
    Corners<kDim, 1> fall = Corners<kDim, 1>::Zero();
    fall[kDim - 1] = -1e9;  // a billion gaps a step
    const double t = safe_fraction<kDim, 1, kDim>(point, fall, facet, Corners<kDim, kDim>::Zero());
    EXPECT_NEAR(t, 0.9e-9, 1e-15);
    // The facet may come to the point as well, and both may fly along together.
    const Corners<kDim, kDim> rise = Corners<kDim, kDim>::Zero().colwise() - fall.col(0);
    EXPECT_NEAR((safe_fraction<kDim, 1, kDim>(point, Corners<kDim, 1>::Zero(), facet, rise)), t,
                1e-15);
    const Corners<kDim, kDim> along = Corners<kDim, kDim>::Zero().colwise() + fall.col(0);
    EXPECT_EQ((safe_fraction<kDim, 1, kDim>(point, fall, facet, along)), 1);
}

TYPED_TEST(CcdTest, LetsSlideWhatSlidesAtATinyGap) {
    constexpr int kDim = TypeParam::value;
    Corners<kDim, 1> point = Corners<kDim, 1>::Constant(0);
    point[kDim - 1] = 1e-9;
    Corners<kDim, 1> slide = Corners<kDim, 1>::Constant(0.5);
    slide[kDim - 1] = 0;
    EXPECT_EQ((safe_fraction<kDim, 1, kDim>(point, slide, this->level_facet(),
                                            Corners<kDim, kDim>::Zero())),
              1);
}

// So near that the direction from one to the other is known to a few digits alone. The checker goes
// by volumes in long double and knows nothing of distances.
TYPED_TEST(CcdTest, NeverLetsThroughWhatIsNearerThanRoundingLetsItSee) {
    constexpr int kDim = TypeParam::value;
    for (int k = 0; k < 2000; ++k) {
        const double gap = std::pow(10.0, -6 - k % 6);
        this->template expect_no_passage<1, kDim>(gap);
        this->template expect_no_passage<2, kDim - 1>(gap);
    }
    EXPECT_GT(this->stopped_, 1000);
}

TYPED_TEST(CcdTest, FindsAPassageThatIsOverInAMillionthOfTheStep) {
    constexpr int kDim = TypeParam::value;
    // A needle of length 1e-6 shot through the middle of a facet: neither end is near it at t = 0
    // or 1.
    Corners<kDim, 1> point = Corners<kDim, 1>::Constant(0);
    point[kDim - 1] = 50;
    Corners<kDim, 1> shot = Corners<kDim, 1>::Zero();
    shot[kDim - 1] = -100;
    const double t =
        safe_fraction<kDim, 1, kDim>(point, shot, this->level_facet(), Corners<kDim, kDim>::Zero());
    EXPECT_LT(t, 0.5);
    EXPECT_GT(t, 0.4);
}

TYPED_TEST(CcdTest, IsZeroWhereThereIsNoGap) {
    constexpr int kDim = TypeParam::value;
    Corners<kDim, 1> point = Corners<kDim, 1>::Zero();
    const Corners<kDim, 1> up = Corners<kDim, 1>::Unit(kDim - 1);
    EXPECT_EQ(
        (safe_fraction<kDim, 1, kDim>(point, up, this->level_facet(), Corners<kDim, kDim>::Zero())),
        0);
    point[kDim - 1] = 0.5;
    EXPECT_EQ((safe_fraction<kDim, 1, kDim>(point, up, this->level_facet(),
                                            Corners<kDim, kDim>::Zero(), {.separation = 0.5})),
              0);
}

TYPED_TEST(CcdTest, TakesNoMoreThanTheLimit) {
    constexpr int kDim = TypeParam::value;
    Corners<kDim, 1> point = Corners<kDim, 1>::Zero();
    point[kDim - 1] = 1;
    const Corners<kDim, 1> fall = -4 * Corners<kDim, 1>::Unit(kDim - 1);
    EXPECT_EQ((safe_fraction<kDim, 1, kDim>(point, fall, this->level_facet(),
                                            Corners<kDim, kDim>::Zero(), {}, 0.1)),
              0.1);
}

// A limit spares work and changes nothing below it: long ways, most of which end early, of pairs
// whose boxes stay apart as far as the limit, and of others.
TYPED_TEST(CcdTest, IsTheSameForAnyLimitUpToIt) {
    constexpr int kDim = TypeParam::value;
    int stopped = 0;
    const auto expect_same = [&]<int K, int L>() {
        const Corners<kDim, K> a = this->template corners<K>(0.3);
        const Corners<kDim, L> b = this->template corners<L>();
        const Corners<kDim, K> va = this->template corners<K>(3);
        const Corners<kDim, L> vb = this->template corners<L>(0.3);
        for (const double distance : {0.02, 0.3}) {
            const Clearance clearance{0.01, distance};
            const double whole = safe_fraction<kDim, K, L>(a, va, b, vb, clearance);
            stopped += whole > 0 && whole < 1 ? 1 : 0;
            for (const double part : {0.01, 0.2, 0.6, 0.9 * whole, 1.001 * whole, 1.1 * whole}) {
                const double limit = std::min(part, 1.0);
                ASSERT_EQ((safe_fraction<kDim, K, L>(a, va, b, vb, clearance, limit)),
                          std::min(whole, limit));
            }
        }
    };
    for (int trial = 0; trial < 3000; ++trial) {
        expect_same.template operator()<1, kDim>();
        expect_same.template operator()<2, kDim - 1>();
    }
    EXPECT_GT(stopped, 500);
}

TYPED_TEST(CcdTest, KeepsPointsOutOfObstacles) {
    constexpr int kDim = TypeParam::value;
    const Vector<kDim> up = Vector<kDim>::Unit(1);
    const std::vector<ObstacleShape<kDim>> obstacles{
        HalfSpace<kDim>{up, -1.0}, Ball<kDim>{Vector<kDim>::Constant(0.2), 0.7},
        Cavity<kDim>{Vector<kDim>::Zero(), 2.5},
        Cuboid<kDim>{Vector<kDim>::Zero(), Vector<kDim>::LinSpaced(0.8, 1.2)},
        Bowl<kDim>{Vector<kDim>::Zero(), 1.5, up}};
    for (const ObstacleShape<kDim>& obstacle : obstacles) {
        int stopped = 0;
        for (int k = 0; k < 2000; ++k) {
            const Vector<kDim> point = this->template corners<1>(1.5);
            const Vector<kDim> motion = this->template corners<1>(std::pow(10.0, k % 4 - 1));
            const double t = safe_fraction<kDim>(obstacle, point, motion);
            const double start = signed_distance<kDim>(obstacle, point).value;
            if (start <= 0) {
                EXPECT_EQ(t, 0);
                continue;
            }
            for (int s = 0; s <= 100; ++s) {
                ASSERT_GE(signed_distance<kDim>(obstacle, point + 0.01 * s * t * motion).value,
                          kGapKept * start - 1e-13);
            }
            if (t < 1) {
                EXPECT_LE(signed_distance<kDim>(obstacle, point + t * motion).value,
                          2.0001 * kGapKept * start);
                ++stopped;
            }
        }
        EXPECT_GT(stopped, 20);
    }
}

// Past the top of a ball so near that ten thousand advances do not get by: as far as is safe, no
// farther. Each goes on by what may be lost of the gap, which only grows, but for a rounding of
// 1e-7 of it.
TYPED_TEST(CcdTest, GivesUpSafelyWhereItWouldTakeTooLong) {
    constexpr int kDim = TypeParam::value;
    constexpr double kGap = 1e-9;
    const ObstacleShape<kDim> ball = Ball<kDim>{Vector<kDim>::Zero(), 1};
    const Vector<kDim> point = (1 + kGap) * Vector<kDim>::Unit(1);
    const Vector<kDim> motion = 3 * Vector<kDim>::Unit(0);
    const double t = safe_fraction<kDim>(ball, point, motion);
    EXPECT_GT(3 * t, 0.999 * 10'000 * (1 - kGapKept) * kGap);
    EXPECT_LT(t, 1);
    for (int s = 0; s <= 100; ++s) {
        ASSERT_GE(signed_distance<kDim>(ball, point + 0.01 * s * t * motion).value,
                  kGapKept * kGap);
    }
}

TYPED_TEST(CcdTest, SlidesAlongAWallInOneStep) {
    constexpr int kDim = TypeParam::value;
    const Vector<kDim> up = Vector<kDim>::Unit(1);
    const Vector<kDim> point = 1e-9 * up;
    const Vector<kDim> motion = 100 * Vector<kDim>::Unit(0);
    EXPECT_EQ(safe_fraction<kDim>(HalfSpace<kDim>{up, 0}, point, motion), 1);
}

}  // namespace
}  // namespace pent::contact
