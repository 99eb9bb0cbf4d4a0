#include "model/obstacle_motions.h"

#include "contact_scenes.h"

#include <pent/contact/obstacles.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace pent::simulator {
namespace {

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;

template <typename T>
class ObstacleMotionsTest : public testing::Test {};
TYPED_TEST_SUITE(ObstacleMotionsTest, Dimensions);

// One of every shape but the box, each moved in two ways, one after the other.
template <int Dim>
Scene moving_scene() {
    const Eigen::VectorXd center = Eigen::VectorXd::LinSpaced(Dim, -0.3, 0.4);
    const Eigen::VectorXd up = Eigen::VectorXd::LinSpaced(Dim, 0.2, 1).normalized();
    Scene scene = test::box_scene<Dim>();
    scene.obstacles = {{.shape = HalfSpaceObstacle{.normal = up, .offset = 0.3}},
                       {.shape = BallObstacle{.center = center, .radius = 0.5}},
                       {.shape = CavityObstacle{.center = center, .radius = 2}},
                       {.shape = BowlObstacle{.center = center, .radius = 1, .up = up}}};
    for (Obstacle& obstacle : scene.obstacles) {
        Motion first = test::still(Dim);
        first.translate = Eigen::VectorXd::LinSpaced(Dim, 0.5, -0.2);
        first.rotate = {{.plane = {0, Dim - 1}, .degrees_per_s = 70}};
        Motion second = test::still(Dim);
        second.rotate = {{.plane = {1, 2}, .degrees_per_s = -40}};
        second.about = Eigen::VectorXd::Constant(Dim, 0.1);
        second.from = 0.5;
        obstacle.motion = {first, second};
    }
    return scene;
}

// A rigid motion keeps distances: what goes with the obstacle stays as far from it. Where a point
// goes is what displacement() says.
TYPED_TEST(ObstacleMotionsTest, CarryPointsAlongAtTheSameSignedDistance) {
    constexpr int kDim = TypeParam::value;
    const ObstacleMotions<kDim> motions(moving_scene<kDim>());
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-1, 1);
    const auto start = motions.at(0.2);
    const auto end = motions.at(1.4);
    for (std::size_t i = 0; i < start.size(); ++i) {
        for (int k = 0; k < 20; ++k) {
            const Vector<kDim> now = Vector<kDim>::NullaryExpr([&] { return place(random); });
            const Vector<kDim> later = now + motions.displacement(i, now, 0.2, 1.4);
            EXPECT_NEAR(contact::signed_distance<kDim>(start[i], now).value,
                        contact::signed_distance<kDim>(end[i], later).value, 1e-13)
                << i;
        }
        EXPECT_TRUE(motions.is_moving(i, 0.2, 0.3));
    }
}

TYPED_TEST(ObstacleMotionsTest, LeaveWhatDoesNotMoveToTheBit) {
    constexpr int kDim = TypeParam::value;
    Scene scene = moving_scene<kDim>();
    scene.obstacles[1].motion.clear();
    scene.obstacles[2].motion = {test::still(kDim)};
    const ObstacleMotions<kDim> motions(scene);
    EXPECT_TRUE(motions.is_any());
    const auto later = motions.at(2);
    for (const std::size_t i : {std::size_t{1}, std::size_t{2}}) {
        EXPECT_FALSE(motions.is_moving(i, 0, 2));
    }
    EXPECT_EQ(std::get<Ball<kDim>>(later[1]).center,
              Vector<kDim>(std::get<BallObstacle>(scene.obstacles[1].shape).center));
    EXPECT_EQ(std::get<Cavity<kDim>>(later[2]).center,
              Vector<kDim>(std::get<CavityObstacle>(scene.obstacles[2].shape).center));
    scene.obstacles.resize(2);
    EXPECT_TRUE(ObstacleMotions<kDim>(scene).is_any());  // the first, not the last
    scene.obstacles[0].motion.clear();
    EXPECT_FALSE(ObstacleMotions<kDim>(scene).is_any());
}

// Far from the origin as near it: what turns about a place is where it would be by formulas in
// long double, to the rounding of that place, and a point of it goes as far.
TYPED_TEST(ObstacleMotionsTest, TurnToTheRoundingOfTheirPlaceHoweverFarAway) {
    constexpr int kDim = TypeParam::value;
    using Long = Eigen::Matrix<long double, kDim, 1>;
    for (const double place : {0.0, 1e3, 1e8}) {
        Scene scene = test::box_scene<kDim>();
        const Eigen::VectorXd center = place * Eigen::VectorXd::LinSpaced(kDim, 0.3, 1);
        const Eigen::VectorXd about = center + Eigen::VectorXd::LinSpaced(kDim, 2, -1);
        Motion itself = test::still(kDim);
        itself.rotate = {{.plane = {0, kDim - 1}, .degrees_per_s = 50}};
        Motion around = itself;
        around.about = about;
        around.translate = Eigen::VectorXd::LinSpaced(kDim, 0.5, -0.2);
        for (const Motion& motion : {itself, around}) {
            scene.obstacles.push_back(
                {.shape = BallObstacle{.center = center, .radius = 0.5}, .motion = {motion}});
        }
        const ObstacleMotions<kDim> motions(scene);
        const double time = 0.7;
        const long double angle = 50 * time * std::numbers::pi_v<long double> / 180;
        const auto turned = [&](const Long& arm) {
            Long result = arm;
            result[0] = std::cos(angle) * arm[0] - std::sin(angle) * arm[kDim - 1];
            result[kDim - 1] = std::sin(angle) * arm[0] + std::cos(angle) * arm[kDim - 1];
            return result;
        };
        const Vector<kDim> middles[] = {center, about};
        const auto now = motions.at(time);
        for (std::size_t i = 0; i < 2; ++i) {
            const Long middle = middles[i].template cast<long double>();
            const auto moved = [&](const Vector<kDim>& point) -> Long {
                return turned(point.template cast<long double>() - middle) + middle
                       + static_cast<long double>(time)
                             * scene.obstacles[i].motion[0].translate.template cast<long double>();
            };
            // A few roundings of places of this size.
            const double rounding = 1e-15 * (1 + place * std::sqrt(kDim));
            const Vector<kDim> end = std::get<Ball<kDim>>(now[i]).center;
            EXPECT_LT((end.template cast<long double>() - moved(center)).norm(), rounding)
                << place << " " << i;
            const Vector<kDim> point = center + Eigen::VectorXd::Constant(kDim, 0.4);
            const Long way = moved(point) - point.template cast<long double>();
            EXPECT_LT(
                (motions.displacement(i, point, 0, time).template cast<long double>() - way).norm(),
                rounding)
                << place << " " << i;
        }
    }
}

// Its axes are those of the same box near the origin: they stay a rotation.
TYPED_TEST(ObstacleMotionsTest, KeepABoxABoxHoweverFarAwayItTurns) {
    constexpr int kDim = TypeParam::value;
    Scene scene = test::box_scene<kDim>();
    const Eigen::VectorXd sides = Eigen::VectorXd::LinSpaced(kDim, 1, 2);
    Motion turn = test::still(kDim);
    turn.rotate = {{.plane = {0, 1}, .degrees_per_s = 50},
                   {.plane = {kDim - 1, 1}, .degrees_per_s = 30}};
    for (const double place : {0.0, 1e8}) {
        scene.obstacles.push_back(
            {.shape = BoxObstacle{.center = Eigen::VectorXd::Constant(kDim, place), .sides = sides},
             .motion = {turn}});
    }
    const auto later = ObstacleMotions<kDim>(scene).at(0.7);
    const auto& near = std::get<Cuboid<kDim>>(later[0]);
    const auto& far = std::get<Cuboid<kDim>>(later[1]);
    EXPECT_GT((near.axes - Matrix<kDim>::Identity()).norm(), 0.5);
    EXPECT_LT((far.axes - near.axes).norm(), 1e-14);
    EXPECT_LT((far.axes.transpose() * far.axes - Matrix<kDim>::Identity()).norm(), 1e-14);
}

// A ball that turns about itself is where it was, but its surface moves.
TYPED_TEST(ObstacleMotionsTest, TurnAnObstacleAboutItsCenterUnlessItIsToldOtherwise) {
    constexpr int kDim = TypeParam::value;
    Scene scene = moving_scene<kDim>();
    Motion turn = test::still(kDim);
    turn.rotate = {{.plane = {0, 1}, .degrees_per_s = 90}};
    scene.obstacles[1].motion = {turn};
    scene.obstacles[2].motion = {turn};
    std::get<CavityObstacle>(scene.obstacles[2].shape).center.setZero();
    const ObstacleMotions<kDim> motions(scene);
    EXPECT_TRUE(motions.is_moving(2, 0, 1));  // though its map has no shift
    const Vector<kDim> center = std::get<Ball<kDim>>(motions.at(0)[1]).center;
    EXPECT_LT((std::get<Ball<kDim>>(motions.at(1)[1]).center - center).norm(), 1e-15);
    const Vector<kDim> right = center + 0.5 * Vector<kDim>::Unit(0);
    // A quarter turn later it is at the top: x goes towards y.
    EXPECT_LT((motions.displacement(1, right, 0, 1)
               - 0.5 * (Vector<kDim>::Unit(1) - Vector<kDim>::Unit(0)))
                  .norm(),
              1e-15);
}

}  // namespace
}  // namespace pent::simulator
