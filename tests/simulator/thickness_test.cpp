#include "contact_scenes.h"
#include "model/rotation.h"
#include "support/kuhn_box.h"
#include "support/messages.h"

#include <pent/simulator/thickness.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

namespace pent::simulator {
namespace {

template <typename T>
class Thickness : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(Thickness, Dimensions);

// A rotation by random angles in all planes.
template <int Dim>
Eigen::Matrix<double, Dim, Dim> turned(std::mt19937& random) {
    std::uniform_real_distribution<double> degrees(-180, 180);
    Eigen::Matrix<double, Dim, Dim> rotation = Eigen::Matrix<double, Dim, Dim>::Identity();
    for (int from = 0; from < Dim; ++from) {
        for (int to = from + 1; to < Dim; ++to) {
            const Turn turn{.plane = {from, to}, .degrees = degrees(random)};
            rotation = rotation_of<Dim>({turn}) * rotation;
        }
    }
    return rotation;
}

template <int Dim>
SimplexMesh<Dim> box_of(const std::array<double, Dim>& sides) {
    std::array<int, Dim> count{};
    count.fill(2);
    return pent::test::kuhn_box<Dim>(count, sides);
}

TYPED_TEST(Thickness, OfAnUprightBoxIsItsShortestSideToTheBit) {
    constexpr int kDim = TypeParam::value;
    for (int thin = 0; thin < kDim; ++thin) {
        std::array<double, kDim> sides{};
        sides.fill(1);
        sides[static_cast<std::size_t>(thin)] = 0.1;
        EXPECT_EQ(thickness<kDim>(box_of<kDim>(sides).positions), 0.1);
        sides.fill(0.3);
        EXPECT_EQ(thickness<kDim>(box_of<kDim>(sides).positions), 0.3);
    }
}

// However it is turned, and wherever it is.
TYPED_TEST(Thickness, OfAPlateDoesNotDependOnHowItIsTurned) {
    constexpr int kDim = TypeParam::value;
    std::mt19937 random(5);
    for (const double thin : {0.5, 0.1, 0.001}) {
        std::array<double, kDim> sides{};
        sides.fill(1);
        sides[1] = thin;
        const Positions<kDim> plate = box_of<kDim>(sides).positions;
        for (int k = 0; k < 20; ++k) {
            Positions<kDim> x = turned<kDim>(random) * plate;
            x.colwise() += Eigen::Vector<double, kDim>::LinSpaced(-3, 7);
            EXPECT_NEAR(thickness<kDim>(x), thin, 1e-8 * thin + 1e-14) << k;
        }
    }
}

// The width in the narrowest of many directions is a bound from above of that in the narrowest of
// all, which is what a body is not thinner than.
TYPED_TEST(Thickness, IsBetweenTheWidthOfABodyAndTheUprightBox) {
    constexpr int kDim = TypeParam::value;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> draw(0.1, 1);
    for (int k = 0; k < 50; ++k) {
        std::array<double, kDim> sides{};
        for (double& side : sides) {
            side = k % 3 == 0 ? 0.4 : draw(random);  // some without axes of their own
        }
        const double narrowest = *std::min_element(sides.begin(), sides.end());
        const Positions<kDim> x = turned<kDim>(random) * box_of<kDim>(sides).positions;
        const double upright = (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).minCoeff();
        EXPECT_GE(thickness<kDim>(x), narrowest * (1 - 1e-8));
        EXPECT_LE(thickness<kDim>(x), upright);
    }
}

// A step that takes two plates past each other by more than they are thick is refused, whichever
// way they face.
TYPED_TEST(Thickness, IsWhatNothingMovesByInAStepWhereBodiesMeet) {
    constexpr int kDim = TypeParam::value;
    for (const double degrees : {0.0, 45.0}) {
        Scene scene = test::box_scene<kDim>();
        scene.frames_per_second = 30;
        scene.solver.max_halvings = 0;
        scene.contact = ContactSettings{.distance = 0.01};
        scene.bodies[0].place.rotate = {{.plane = {0, 1}, .degrees = degrees}};
        scene.bodies[0].velocity = 30 * 0.3 * Eigen::VectorXd::Unit(kDim, 0);
        scene.bodies.push_back(scene.bodies[0]);
        scene.bodies[1].name = "other";
        scene.bodies[1].velocity *= -1;
        scene.bodies[1].place.translate = 9 * Eigen::VectorXd::Unit(kDim, 1);
        std::array<double, kDim> sides{};
        sides.fill(1);
        sides[0] = 0.1;
        Simulation<kDim> simulation(scene, {box_of<kDim>(sides), box_of<kDim>(sides)});
        pent::test::expect_contains(simulation.step().failure, {"could pass through each other"});
    }
}

}  // namespace
}  // namespace pent::simulator
