#include <pent/contact/distance_energy.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace pent::contact {
namespace {

constexpr double kEps = 0.02;
constexpr double kStiffness = 1000;
constexpr DistanceEnergy kAnyDepth{DistanceLaw::Penalty, kEps, kStiffness};
constexpr DistanceEnergy kFading{DistanceLaw::FadingPenalty, kEps, kStiffness};

TEST(Penalty, IsThatOfThePaperOutside) {
    EXPECT_DOUBLE_EQ(kAnyDepth.value(0.005), 1000 * 0.015 * 0.015);
    EXPECT_DOUBLE_EQ(kFading.value(0.005), 1000 * 0.015 * 0.015);
    EXPECT_EQ(kAnyDepth.value(kEps), 0);
    EXPECT_EQ(kAnyDepth.slope(1.0), 0);
    EXPECT_EQ(kFading.curvature(1.0), 0);
}

TEST(Penalty, PushesOutAtAnyDepthAndHarderTheDeeper) {
    for (const double depth : {1e-12, 0.01, kEps, 3.0, 1e6}) {
        EXPECT_LT(kAnyDepth.slope(-2 * depth), kAnyDepth.slope(-depth));
        EXPECT_LT(kAnyDepth.slope(-depth), 0);
    }
}

TEST(Penalty, FadesOutAtTheDepthOfTheDistance) {
    EXPECT_NEAR(kFading.slope(-kEps * (1 - 1e-9)), 0, 1e-6 * kStiffness * kEps);
    EXPECT_EQ(kFading.slope(-kEps), 0);
    EXPECT_NEAR(-kFading.slope(-kEps / 4), 2.25 * kStiffness * kEps, 1e-12);
    for (double d = -kEps * 0.99; d < 0; d += kEps / 50) {
        EXPECT_LT(kFading.slope(d), 0);  // never pulls in
    }
}

TEST(Penalty, IsContinuousWithItsForceWhereItChangesItsForm) {
    for (const DistanceEnergy& penalty : {kAnyDepth, kFading}) {
        for (const double d : {0.0, kEps}) {
            const double h = 1e-12 * kEps;
            EXPECT_NEAR(penalty.value(d - h), penalty.value(d + h), 1e-11);
            EXPECT_NEAR(penalty.slope(d - h), penalty.slope(d + h), 1e-7);
        }
        EXPECT_NEAR(penalty.curvature(-1e-14), penalty.curvature(1e-14), 1e-6);
    }
}

TEST(Penalty, HasDerivativesThatAreCentralDifferences) {
    for (const DistanceEnergy& penalty : {kAnyDepth, kFading}) {
        for (double d = -0.97 * kEps; d < kEps; d += 0.1 * kEps) {
            const double h = 1e-5 * kEps;
            // psi is a cubic polynomial: truncation k h^2 / eps, rounding 1e-16 psi / h.
            EXPECT_NEAR(penalty.slope(d), (penalty.value(d + h) - penalty.value(d - h)) / (2 * h),
                        1e-7);
            EXPECT_NEAR(penalty.curvature(d),
                        (penalty.slope(d + h) - penalty.slope(d - h)) / (2 * h), 1e-5 * kStiffness);
        }
    }
}

constexpr double kHuge = std::numeric_limits<double>::infinity();

TEST(Barrier, IsNothingFromFarAndGrowsWithoutBound) {
    const DistanceEnergy barrier{DistanceLaw::Barrier, 0.1, 50, 0.02};
    EXPECT_EQ(barrier.value(0.1201), 0);
    EXPECT_EQ(barrier.slope(0.3), 0);
    EXPECT_EQ(barrier.curvature(0.3), 0);
    double last = 0;
    for (double gap = 0.09; gap > 1e-9; gap /= 2) {
        const double energy = barrier.value(0.02 + gap);
        EXPECT_GT(energy, last);
        EXPECT_LT(barrier.slope(0.02 + gap), 0);
        EXPECT_GT(barrier.curvature(0.02 + gap), 0);
        last = energy;
    }
    for (const double d : {0.02, 0.01, -0.3}) {
        EXPECT_EQ(barrier.value(d), kHuge);
        EXPECT_EQ(barrier.slope(d), -kHuge);
        EXPECT_EQ(barrier.curvature(d), kHuge);
    }
}

TEST(Barrier, HasTheValueWorkedByHandAtHalfItsDistance) {
    // y = 1/4: -50 * 0.01 * (9/16) ln(1/4).
    EXPECT_NEAR((DistanceEnergy{DistanceLaw::Barrier, 0.1, 50}).value(0.05),
                0.5 * 9 / 16 * std::log(4), 1e-15);
}

TEST(Barrier, HasDerivativesThatAreCentralDifferences) {
    const DistanceEnergy barrier{DistanceLaw::Barrier, 0.1, 50, 0.02};
    for (double gap = 1e-4; gap < 0.0999; gap *= 1.3) {
        const double h = 1e-4 * gap;
        const double d = 0.02 + gap;
        const double slope = (barrier.value(d + h) - barrier.value(d - h)) / (2 * h);
        const double curvature = (barrier.slope(d + h) - barrier.slope(d - h)) / (2 * h);
        // Truncation (h / gap)^2 = 1e-8 of the value; rounding 1e-16 energy / h.
        EXPECT_NEAR(barrier.slope(d), slope, 1e-6 * std::abs(slope) + 1e-9);
        EXPECT_NEAR(barrier.curvature(d), curvature, 1e-6 * std::abs(curvature) + 1e-6);
    }
    // Twice continuously differentiable where it ends.
    EXPECT_NEAR(barrier.curvature(0.12 - 1e-9), 0, 1e-4);
}

}  // namespace
}  // namespace pent::contact
