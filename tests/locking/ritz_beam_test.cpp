#include "beams.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pent::locking {
namespace {

template <typename T>
class RitzBeamTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(RitzBeamTest, Dimensions);

// Where nothing contracts across, u = x (4 - x / 2) along the beam, which is of degree 2.
TYPED_TEST(RitzBeamTest, IsExactWherePulledAlongItself) {
    constexpr int kDim = TypeParam::value;
    BodyForce<kDim> load;
    load.steady[0] = 1;
    for (const RitzDegrees degrees : {RitzDegrees{2, 0}, RitzDegrees{7, 3}}) {
        EXPECT_NEAR(RitzBeam<kDim>(0, degrees).work(load), 64.0 / 3, 1e-11);
    }
}

// More polynomials give more work, never more than the true one. Stresses are singular where the
// beam is held, so the missing part falls as a power of the degree; it falls as fast as the power
// 2.5 at least, and then the last step tells what is missing at most.
TYPED_TEST(RitzBeamTest, LacksLessThanTwoThousandths) {
    constexpr int kDim = TypeParam::value;
    const auto part = [](int across) { return std::pow(across, -2.5); };
    for (const double share : {kShares[1], kShares[2], kShares[3], kShares[4]}) {
        const double poisson = share * simulator::poisson_limit(kDim);
        for (const Load load : {Load::Bending, Load::Twist}) {
            const auto work = [&](RitzDegrees degrees) {
                return RitzBeam<kDim>(poisson, degrees).work(body_force<kDim>(load));
            };
            const double low = work({24, 8});
            const double middle = work({32, 10});
            const double high = work({});
            const double last_step = high - middle;
            EXPECT_GT(last_step, 0) << share;
            EXPECT_GT((middle - low) / last_step, (part(8) - part(10)) / (part(10) - part(12)))
                << share;
            EXPECT_LT(last_step * part(12) / (part(10) - part(12)), 0.002 * high) << share;
        }
    }
}

// Bent along the diagonal a beam is bent along each axis, each in a class of its own.
TYPED_TEST(RitzBeamTest, BendsAlongTheDiagonalAsAlongEveryAxis) {
    constexpr int kDim = TypeParam::value;
    const RitzBeam<kDim> beam(0.3, {8, 4});
    const double one = beam.work(body_force<kDim>(Load::Bending));
    const double all = beam.work(body_force<kDim>(Load::Diagonal));
    EXPECT_NEAR(all, (kDim - 1) * one, 1e-10 * all);
}

}  // namespace
}  // namespace pent::locking
