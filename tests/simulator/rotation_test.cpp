#include "model/rotation.h"

#include "support/kuhn_box.h"

#include <pent/error.h>
#include <pent/simulator/placed_mesh.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace pent::simulator {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;

TEST(PlaneRotation, TakesTheFirstAxisTowardsTheSecondInEveryPlane) {
    for (int from = 0; from < 4; ++from) {
        for (int to = 0; to < 4; ++to) {
            if (from == to) {
                continue;
            }
            const Matrix<4> R = plane_rotation<4>({from, to}, kQuarter);
            EXPECT_LT((R * Vector<4>::Unit(from) - Vector<4>::Unit(to)).norm(), 1e-15);
            EXPECT_LT((R * R.transpose() - Matrix<4>::Identity()).norm(), 1e-15);
            const Matrix<4> back = plane_rotation<4>({to, from}, kQuarter);
            EXPECT_LT((R * back - Matrix<4>::Identity()).norm(), 1e-15);  // "wx" undoes "xw"
        }
    }
}

Body placed(double scale, const std::vector<Turn>& turns, const Vector<4>& shift) {
    Body body;
    body.name = "box";
    body.mesh = "box.pent";
    body.place = {.scale = scale, .rotate = turns, .translate = shift};
    return body;
}

TEST(Place, ScalesThenTurnsInTheOrderWrittenThenMoves) {
    SimplexMesh<4> mesh = pent::test::kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 1});
    mesh.fibers = Vector<4>::Unit(0).replicate(1, mesh.cell_count());  // as long as before
    // Corner (1,0,0,0): scaled to 2 x; x towards w: 2 w; w towards y: 2 y; moved.
    const Body body = placed(2, {{{0, 3}, 90}, {{3, 1}, 90}}, Vector<4>(10, 0, 0, 0));
    const SimplexMesh<4> result = place(mesh, body);
    EXPECT_LT((result.positions.col(1) - Vector<4>(10, 2, 0, 0)).norm(), 1e-14);
    EXPECT_NEAR(total_volume(result), 16, 1e-12);
    EXPECT_LT((result.fibers.colwise() - Vector<4>::Unit(1)).norm(), 1e-14);
}

TEST(Place, LeavesAMeshWithoutPlacementAsItIs) {
    const SimplexMesh<4> mesh = pent::test::kuhn_box<4>({2, 1, 1, 1}, {0.3, 1, 1, 1});
    const SimplexMesh<4> result = place(mesh, placed(1, {}, Vector<4>::Zero()));
    EXPECT_EQ(result.positions, mesh.positions);
}

TEST(Place, RefusesAScaleThatOverflows) {
    const SimplexMesh<4> mesh = pent::test::kuhn_box<4>({1, 1, 1, 1}, {1e300, 1, 1, 1});
    EXPECT_THROW(static_cast<void>(place(mesh, placed(1e300, {}, Vector<4>::Zero()))), Error);
}

Motion double_rotation() {
    Motion motion;
    motion.translate = Vector<4>(0.1, 0, 0, -0.2);
    motion.rotate = {{{1, 2}, 90}, {{3, 0}, 60}};
    motion.from = 0.5;
    motion.to = 2.5;
    return motion;
}

TEST(PoseAt, IsTheExactRotationOfTheTimeElapsed) {
    const Pose<4> pose = pose_at<4>(double_rotation(), 1.5);  // one second in
    EXPECT_LT((pose.rotation * Vector<4>::Unit(1) - Vector<4>::Unit(2)).norm(), 1e-15);
    const Vector<4> w_turned(std::sin(std::numbers::pi / 3), 0, 0, 0.5);
    EXPECT_LT((pose.rotation * Vector<4>::Unit(3) - w_turned).norm(), 1e-15);
    EXPECT_LT((pose.shift - Vector<4>(0.1, 0, 0, -0.2)).norm(), 1e-15);
    EXPECT_LT((pose.rotation * pose.rotation.transpose() - Matrix<4>::Identity()).norm(), 1e-14);
}

TEST(PoseAt, RestsBeforeFromAndHoldsAfterTo) {
    EXPECT_EQ(pose_at<4>(double_rotation(), 0.2).rotation, Matrix<4>::Identity());
    EXPECT_EQ(pose_at<4>(double_rotation(), 0.2).velocity, Vector<4>::Zero());
    const Pose<4> end = pose_at<4>(double_rotation(), 2.5);
    const Pose<4> later = pose_at<4>(double_rotation(), 9);
    EXPECT_EQ(later.rotation, end.rotation);
    EXPECT_EQ(later.shift, end.shift);
    EXPECT_EQ(later.rate, Matrix<4>::Zero());
}

TEST(PoseAt, HasRatesEqualToTheDifferenceInTime) {
    const double h = 1e-5;
    const Pose<4> pose = pose_at<4>(double_rotation(), 1.2);
    const Pose<4> before = pose_at<4>(double_rotation(), 1.2 - h);
    const Pose<4> after = pose_at<4>(double_rotation(), 1.2 + h);
    // Central differences: h^2 and 1e-16 / h, both about 1e-10.
    EXPECT_LT(((after.rotation - before.rotation) / (2 * h) - pose.rate).norm(), 1e-9);
    EXPECT_LT(((after.shift - before.shift) / (2 * h) - pose.velocity).norm(), 1e-9);
}

// Two turns in planes that share an axis do not commute: the first one written comes first.
TEST(PoseAt, AppliesSpinsInTheOrderWritten) {
    Motion motion;
    motion.translate = Vector<4>::Zero();
    motion.rotate = {{{0, 1}, 90}, {{1, 2}, 90}};
    const Pose<4> pose = pose_at<4>(motion, 1);
    EXPECT_LT((pose.rotation * Vector<4>::Unit(0) - Vector<4>::Unit(2)).norm(), 1e-15);
}

Motion through_keyframes() {
    Motion motion;
    motion.translate = Vector<4>::Zero();
    motion.from = 0.5;
    motion.keyframes = {
        {.time = 1,
         .translate = Vector<4>(1, 0, 0, -2),
         .rotate = {{{0, 3}, 90}},
         .velocity = Vector<4>(0, 1, 0, 3),
         .spin = {{{0, 3}, -45}}},
        {.time = 2,
         .translate = Vector<4>(0, 0, 5, 0),
         .rotate = {{{0, 3}, 30}, {{1, 2}, 60}},
         .velocity = {},
         .spin = {}},
        {.time = 3,
         .translate = Vector<4>(0, 0, 6, 0),
         .rotate = {{{1, 2}, 90}},
         .velocity = {},
         .spin = {{{1, 2}, 10}}},
    };
    return motion;
}

TEST(PoseAt, GoesThroughKeyframesWithTheVelocitiesGiven) {
    const double degree = std::numbers::pi / 180;
    const Motion motion = through_keyframes();
    for (const double time : {0.0, 0.5}) {
        EXPECT_EQ(pose_at<4>(motion, time).rotation, Matrix<4>::Identity());
        EXPECT_EQ(pose_at<4>(motion, time).shift, Vector<4>::Zero());
        EXPECT_EQ(pose_at<4>(motion, time).velocity, Vector<4>::Zero());
    }
    const Pose<4> first = pose_at<4>(motion, 1);
    EXPECT_LT((first.shift - Vector<4>(1, 0, 0, -2)).norm(), 1e-14);
    EXPECT_LT((first.velocity - Vector<4>(0, 1, 0, 3)).norm(), 1e-14);
    EXPECT_LT((first.rotation - plane_rotation<4>({0, 3}, 90 * degree)).norm(), 1e-14);
    // x has become w, which turns back towards x at 45 degrees a second: in the plane wx, above 0.
    EXPECT_NEAR((first.rate * Vector<4>::Unit(0))[0], 45 * degree, 1e-14);
    const Pose<4> second = pose_at<4>(motion, 2);
    const Matrix<4> both =
        plane_rotation<4>({1, 2}, 60 * degree) * plane_rotation<4>({0, 3}, 30 * degree);
    EXPECT_LT((second.rotation - both).norm(), 1e-14);
    const Pose<4> end = pose_at<4>(motion, 3);
    EXPECT_LT((end.rotation - plane_rotation<4>({1, 2}, 90 * degree)).norm(), 1e-14);
    EXPECT_NEAR((end.rate * Vector<4>::Unit(1))[1], -10 * degree, 1e-14);
    const Pose<4> later = pose_at<4>(motion, 3.01);
    EXPECT_EQ(later.rotation, end.rotation);
    EXPECT_EQ(later.rate, Matrix<4>::Zero());
}

// Without any rate, each plane by itself, in the order in which they come.
TEST(PoseAt, GoesThroughKeyframesThatOnlySayHowFarItIsTurned) {
    Motion motion;
    motion.translate = Eigen::Vector4d::Zero();
    const Plane first = {3, 0};
    const Plane second = {1, 2};
    motion.keyframes.resize(2);
    motion.keyframes[0].time = 1;
    motion.keyframes[0].rotate = {{first, 40}};
    motion.keyframes[1].time = 3;
    motion.keyframes[1].rotate = {{first, -20}, {second, 70}};
    for (MotionKeyframe& keyframe : motion.keyframes) {
        keyframe.translate = Eigen::Vector4d::Zero();
    }
    constexpr double kDegree = std::numbers::pi / 180;
    const auto turned = [&](double a, double b) -> Matrix<4> {
        return plane_rotation<4>(second, b * kDegree) * plane_rotation<4>(first, a * kDegree);
    };
    EXPECT_LT((pose_at<4>(motion, 1).rotation - turned(40, 0)).norm(), 1e-14);
    EXPECT_LT((pose_at<4>(motion, 3).rotation - turned(-20, 70)).norm(), 1e-14);
    EXPECT_LT((pose_at<4>(motion, 2).rotation - turned(10, 35)).norm(), 1e-14);  // half of the way
    motion.keyframes[1].rotate[0].degrees = -100;
    EXPECT_NEAR(largest_turn_rate(motion), 70, 1e-12);  // back by 140 degrees in 2 s
}

TEST(PoseAt, HasRatesThroughKeyframesEqualToTheDifferenceInTime) {
    const double h = 1e-5;
    for (const double time : {0.6, 0.9, 1.3, 1.9, 2.2, 2.8}) {
        const Pose<4> pose = pose_at<4>(through_keyframes(), time);
        const Pose<4> before = pose_at<4>(through_keyframes(), time - h);
        const Pose<4> after = pose_at<4>(through_keyframes(), time + h);
        EXPECT_LT(((after.rotation - before.rotation) / (2 * h) - pose.rate).norm(), 1e-7);
        EXPECT_LT(((after.shift - before.shift) / (2 * h) - pose.velocity).norm(), 1e-7);
    }
}

// Times of steps are sums, which may be a rounding error behind a keyframe.
TEST(PoseAt, MovesAtTheEndOfAMotionToRounding) {
    const double time = 0.1 + 0.2;  // above 0.3
    Motion motion;
    motion.translate = Vector<4>(1, 0, 0, 0);
    motion.to = 0.3;
    EXPECT_EQ(pose_at<4>(motion, time).velocity, Vector<4>(1, 0, 0, 0));
    motion.to = std::numeric_limits<double>::infinity();
    motion.keyframes = {{.time = 0.3,
                         .translate = Vector<4>(0, 1, 0, 0),
                         .rotate = {},
                         .velocity = Vector<4>(0, 2, 0, 0),
                         .spin = {}}};
    motion.translate.setZero();
    EXPECT_LT((pose_at<4>(motion, time).velocity - Vector<4>(0, 2, 0, 0)).norm(), 1e-12);
}

// A step ends where one motion ends and the next begins, or next to it, since times are rounded:
// it has moved by the first alone. In the first step of all there was none before.
TEST(PoseAt, HasTheVelocityOfTheStepThatEndsThere) {
    for (const double rate : {24.0, 30.0, 60.0, 100.0, 240.0}) {
        double sum = 0;
        for (int k = 1; k <= 300; ++k) {
            sum += 1 / rate;
            for (const double boundary : {k / rate, k * (1 / rate), sum}) {
                Motion first = double_rotation();
                first.from = 0;
                first.to = boundary;
                Motion second = first;
                second.from = boundary;
                second.to = std::numeric_limits<double>::infinity();
                for (const double end : {k / rate, k * (1 / rate), sum}) {
                    EXPECT_EQ(pose_at<4>(first, end).velocity, first.translate) << rate << " " << k;
                    EXPECT_EQ(pose_at<4>(second, end).velocity, Vector<4>::Zero())
                        << rate << " " << k;
                    EXPECT_EQ(pose_at<4>(second, end).rate, Matrix<4>::Zero());
                    EXPECT_EQ(pose_at<4>(second, end + 1 / rate).velocity, second.translate);
                }
            }
        }
    }
    Motion from_the_start = double_rotation();
    from_the_start.from = 0;
    EXPECT_EQ(pose_at<4>(from_the_start, 0).velocity, from_the_start.translate);
    EXPECT_NE(pose_at<4>(from_the_start, 0).rate, Matrix<4>::Zero());
}

TEST(LargestTurnRate, IsOfTheFastestPlaneAndLegBetweenKeyframes) {
    EXPECT_EQ(largest_turn_rate(double_rotation()), 90);
    EXPECT_NEAR(largest_turn_rate(through_keyframes()), 180, 1e-12);  // 90 degrees in 0.5 s
    EXPECT_EQ(largest_turn_rate(Motion()), 0);
}

}  // namespace
}  // namespace pent::simulator
