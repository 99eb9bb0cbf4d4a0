#include "model/motion_chain.h"

#include "scenes.h"

#include <gtest/gtest.h>

#include <numbers>

namespace pent::simulator {
namespace {

using test::still;

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;

template <typename T>
class MotionChainTest : public testing::Test {};
TYPED_TEST_SUITE(MotionChainTest, Dimensions);

// By 2 m along y, and then, from half a second on, by a quarter turn a second in xy.
template <int Dim>
std::vector<Motion> lift_and_turn() {
    Motion lift = still(Dim);
    lift.translate[1] = 4;
    lift.to = 0.5;
    Motion turn = still(Dim);
    turn.rotate = {{{0, 1}, 90}};
    turn.from = 0.5;
    return {lift, turn};
}

// Worked by hand: (1, 0) is lifted to (1, 2); the middle (0, 0) to (0, 2), about which a quarter
// turn takes it to (0, 3).
TYPED_TEST(MotionChainTest, TurnsAboutWhereTheMiddleIsByThen) {
    constexpr int kDim = TypeParam::value;
    const auto centered = center<kDim>(lift_and_turn<kDim>(), Vector<kDim>::Zero());
    ASSERT_EQ(centered.size(), 2U);
    EXPECT_LT((centered[1].about - 2 * Vector<kDim>::UnitY()).norm(), 1e-14);
    Vector<kDim> point = Vector<kDim>::UnitX();
    Vector<kDim> velocity = Vector<kDim>::Zero();
    MotionChain<kDim>(centered, 1.5).move(point, &velocity);
    EXPECT_LT((point - 3 * Vector<kDim>::UnitY()).norm(), 1e-14);
    const Vector<kDim> expected = -std::numbers::pi / 2 * Vector<kDim>::UnitX();
    EXPECT_LT((velocity - expected).norm(), 1e-14);
}

TYPED_TEST(MotionChainTest, TurnsAboutThePointThatAMotionSays) {
    constexpr int kDim = TypeParam::value;
    std::vector<Motion> motions = lift_and_turn<kDim>();
    motions[1].about = Vector<kDim>::UnitX();
    const auto centered = center<kDim>(motions, Vector<kDim>::Zero());
    EXPECT_EQ(centered[1].about, Vector<kDim>(Vector<kDim>::UnitX()));
    Vector<kDim> point = Vector<kDim>::UnitX();  // lifted to an arm of (0, 2)
    MotionChain<kDim>(centered, 1.5).move(point, nullptr);
    EXPECT_LT((point + Vector<kDim>::UnitX()).norm(), 1e-14);
}

// Turns in several planes, one behind the other, on a path of keyframes: distances stay, and the
// velocity is the derivative of the place, by central differences.
TYPED_TEST(MotionChainTest, IsRigidAndKnowsItsVelocity) {
    constexpr int kDim = TypeParam::value;
    std::vector<Motion> motions = lift_and_turn<kDim>();
    motions[0].rotate = {{{1, 2}, -70}, {{0, kDim - 1}, 200}};
    motions[1].rotate = {{{0, 1}, 90}, {{kDim - 1, 1}, 35}};
    motions.push_back(still(kDim));
    motions[2].keyframes.resize(2);
    motions[2].keyframes[0].time = 0.4;
    motions[2].keyframes[0].translate = Vector<kDim>::LinSpaced(0.1, 0.5);
    motions[2].keyframes[0].rotate = {{{0, 2}, 40}};
    motions[2].keyframes[1].time = 1.7;
    motions[2].keyframes[1].translate = -Vector<kDim>::LinSpaced(0.3, 0.9);
    motions[2].keyframes[1].rotate = {{{0, 2}, -20}};
    const auto centered = center<kDim>(motions, Vector<kDim>::Constant(0.2));
    const Vector<kDim> a = Vector<kDim>::LinSpaced(-1, 0.7);
    const Vector<kDim> b = Vector<kDim>::LinSpaced(2, -0.4);
    const auto at = [&](Vector<kDim> point, double time) {
        MotionChain<kDim>(centered, time).move(point, nullptr);
        return point;
    };
    for (const double time : {0.1, 0.45, 0.8, 1.3}) {
        EXPECT_NEAR((at(a, time) - at(b, time)).norm(), (a - b).norm(), 1e-13) << time;
        Vector<kDim> point = a;
        Vector<kDim> velocity = Vector<kDim>::Zero();
        MotionChain<kDim>(centered, time).move(point, &velocity);
        EXPECT_EQ(point, at(a, time));
        constexpr double kStep = 1e-6;
        const Vector<kDim> slope = (at(a, time + kStep) - at(a, time - kStep)) / (2 * kStep);
        EXPECT_LT((velocity - slope).norm(), 1e-8 * (1 + slope.norm())) << time;
    }
}

TYPED_TEST(MotionChainTest, KeepsPointsToTheBitBeforeItBegins) {
    constexpr int kDim = TypeParam::value;
    std::vector<Motion> motions = lift_and_turn<kDim>();
    motions[0].from = 0.2;
    const auto centered = center<kDim>(motions, Vector<kDim>::Constant(0.1));
    const Vector<kDim> start = Vector<kDim>::LinSpaced(0.1, 1.0 / 3);
    Vector<kDim> point = start;
    MotionChain<kDim>(centered, 0.2).move(point, nullptr);
    EXPECT_EQ(point, start);
}

}  // namespace
}  // namespace pent::simulator
