#include "crossings.h"

#include "scenes.h"
#include "support/crossing_checker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <vector>

namespace pent::contact {
namespace {

template <int Dim>
ContactScene<Dim> scene_of(const test::Scene<Dim>& scene,
                           bool self = false,
                           const std::vector<ObstacleShape<Dim>>& obstacles = {}) {
    return test::contact_scene<Dim>(
        scene, {.model = ContactModel::Barrier, .distance = 0.1, .self = self}, obstacles);
}

template <int Dim>
std::vector<Crossing> crossings_of(const test::Scene<Dim>& scene,
                                   bool self = false,
                                   const std::vector<ObstacleShape<Dim>>& obstacles = {}) {
    return ContactFinder<Dim>(scene_of<Dim>(scene, self, obstacles))
        .find_crossings(scene.positions);
}

int count(const std::vector<Crossing>& crossings, CrossingKind kind) {
    return static_cast<int>(std::count_if(crossings.begin(), crossings.end(),
                                          [&](const Crossing& c) { return c.kind == kind; }));
}

template <typename T>
class CrossingsTest : public testing::Test {};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(CrossingsTest, Dimensions);

TYPED_TEST(CrossingsTest, AreFoundLikeByBruteForce) {
    constexpr int kDim = TypeParam::value;
    for (const double shift : {0.3, 0.9, 1.5}) {
        test::Scene<kDim> scene;
        scene.add(test::cube<kDim>(1), Vector<kDim>::Zero());
        scene.add(test::cube<kDim>(1), Vector<kDim>::Constant(shift));
        test::shake<kDim>(scene.positions, 0.05, 2);
        const int brute = pent::test::count_crossings<kDim>(scene.surfaces[0], scene.surfaces[1],
                                                            scene.positions);
        EXPECT_EQ(brute > 0, shift < 1);
        EXPECT_EQ(count(crossings_of<kDim>(scene), CrossingKind::Through), brute);
    }
}

TEST(Crossings, OfTwoFourDimensionalBodiesMayBeOfTrianglesAlone) {
    // Long in z and w against long in x and y: no edge of either meets the other, but they overlap
    // in the middle. Diagonal edges do cross, so the cells are small against them: edges at the rim
    // only.
    test::Scene<4> scene;
    scene.add(pent::test::kuhn_box<4>({1, 1, 3, 3}, {1, 1, 9, 9}), Vector<4>(0, 0, 0.3, 0.2));
    scene.add(pent::test::kuhn_box<4>({3, 3, 1, 1}, {9, 9, 1, 1}), Vector<4>(-4.1, -3.9, 4.6, 4.4));
    int triangles = 0;
    for (const Crossing& crossing : crossings_of<4>(scene)) {
        triangles +=
            crossing.first_corners.size() == 3 && crossing.second_corners.size() == 3 ? 1 : 0;
    }
    EXPECT_GT(triangles, 0);
    EXPECT_GT(pent::test::count_crossings<4>(scene.surfaces[0], scene.surfaces[1], scene.positions),
              0);
}

TYPED_TEST(CrossingsTest, OfABodyInsideAnotherAreItsVertices) {
    constexpr int kDim = TypeParam::value;
    test::Scene<kDim> scene;
    scene.add(test::cube<kDim>(3), Vector<kDim>::Zero());
    scene.add(test::cube<kDim>(1), Vector<kDim>::Constant(1.1));
    const std::vector<Crossing> crossings = crossings_of<kDim>(scene);
    EXPECT_EQ(crossings.size(), 1U << kDim);
    EXPECT_EQ(count(crossings, CrossingKind::Inside), 1 << kDim);
    EXPECT_EQ(describe<kDim>(crossings[0], scene_of<kDim>(scene)), "vertex 0 of 'b' is inside 'a'");
}

TYPED_TEST(CrossingsTest, TouchingCubesAreReported) {
    constexpr int kDim = TypeParam::value;
    test::Scene<kDim> scene;
    scene.add(test::cube<kDim>(1), Vector<kDim>::Zero());
    scene.add(test::cube<kDim>(1), Vector<kDim>::Unit(0));
    const std::vector<Crossing> touching = crossings_of<kDim>(scene);
    EXPECT_GT(count(touching, CrossingKind::Touching), 0);
    EXPECT_EQ(touching[0].distance, 0);
    scene.body(1).row(0).array() += 1e-6;
    EXPECT_TRUE(crossings_of<kDim>(scene).empty());
}

// A corner on the middle of a side, whichever body comes first.
TYPED_TEST(CrossingsTest, TouchesOfAVertexAreReportedWhoseverItIs) {
    constexpr int kDim = TypeParam::value;
    SimplexMesh<kDim> turned = test::cube<kDim>(1);
    turned.positions = test::tilt<kDim>() * turned.positions;
    Eigen::Index lowest = 0;
    turned.positions.row(0).minCoeff(&lowest);
    Vector<kDim> touch = Vector<kDim>::LinSpaced(1.1, 1.4);  // on no edge of a side
    touch[0] = 3;
    const Vector<kDim> corner = turned.positions.col(lowest);
    turned.positions.colwise() -= corner;
    for (const bool is_first : {false, true}) {
        test::Scene<kDim> scene;
        for (const bool is_corner : {is_first, !is_first}) {
            scene.add(is_corner ? turned : test::cube<kDim>(3),
                      is_corner ? touch : Vector<kDim>::Zero());
        }
        const std::vector<Crossing> touching = crossings_of<kDim>(scene);
        ASSERT_GT(touching.size(), 0U);
        EXPECT_EQ(touching[0].kind, CrossingKind::Touching);
        EXPECT_TRUE(std::any_of(touching.begin(), touching.end(), [](const Crossing& c) {
            return c.first_corners.size() == 1 || c.second_corners.size() == 1;
        }));
        scene.body(is_first ? 0 : 1).row(0).array() += 1e-6;
        EXPECT_TRUE(crossings_of<kDim>(scene).empty());
    }
}

TYPED_TEST(CrossingsTest, WithinABodyAreFoundIfAsked) {
    constexpr int kDim = TypeParam::value;
    test::Scene<kDim> scene;
    scene.add(test::cube<kDim>(2), Vector<kDim>::Zero());
    EXPECT_TRUE(crossings_of<kDim>(scene, true).empty());
    // The corner at 0 goes right through the body and out on the far side.
    scene.positions.col(0) = Vector<kDim>::LinSpaced(1.43, 2.57);
    EXPECT_TRUE(crossings_of<kDim>(scene, false).empty());
    EXPECT_GT(count(crossings_of<kDim>(scene, true), CrossingKind::Through), 0);
}

TYPED_TEST(CrossingsTest, WithinABodyAreTheSameInWhateverOrderItsCellsAre) {
    constexpr int kDim = TypeParam::value;
    using Simplex = std::vector<std::uint32_t>;
    const auto pairs_of = [](SimplexMesh<kDim> mesh) {
        mesh.positions.col(0) = Vector<kDim>::LinSpaced(1.43, 2.57);
        test::Scene<kDim> scene;
        scene.add(mesh, Vector<kDim>::Zero());
        std::set<std::set<Simplex>> pairs;
        for (Crossing crossing : crossings_of<kDim>(scene, true)) {
            std::sort(crossing.first_corners.begin(), crossing.first_corners.end());
            std::sort(crossing.second_corners.begin(), crossing.second_corners.end());
            pairs.insert({crossing.first_corners, crossing.second_corners});
        }
        return pairs;
    };
    SimplexMesh<kDim> mesh = test::cube<kDim>(2);
    const std::set<std::set<Simplex>> pairs = pairs_of(mesh);
    EXPECT_FALSE(pairs.empty());
    std::mt19937 random(8);
    for (int i = 0; i < 5; ++i) {
        Eigen::PermutationMatrix<Eigen::Dynamic> order(mesh.cells.cols());
        order.setIdentity();
        std::shuffle(order.indices().begin(), order.indices().end(), random);
        mesh.cells = (mesh.cells * order).eval();
        EXPECT_EQ(pairs_of(mesh), pairs);
    }
}

TYPED_TEST(CrossingsTest, WithObstaclesAreReported) {
    constexpr int kDim = TypeParam::value;
    test::Scene<kDim> scene;
    scene.add(test::cube<kDim>(1), Vector<kDim>::Zero());
    const Vector<kDim> up = Vector<kDim>::Unit(1);
    EXPECT_TRUE(crossings_of<kDim>(scene, false, {HalfSpace<kDim>{up, -0.1}}).empty());
    const auto sunk = crossings_of<kDim>(scene, false, {HalfSpace<kDim>{up, 0.5}});
    EXPECT_EQ(sunk.size(), 1U << (kDim - 1));
    EXPECT_EQ(describe<kDim>(sunk[0], scene_of<kDim>(scene)),
              "vertex 0 of 'a' is inside obstacle 1");
    // A ball that cuts a side between its vertices.
    Vector<kDim> center = Vector<kDim>::Constant(0.5);
    center[0] = -0.1;
    EXPECT_FALSE(crossings_of<kDim>(scene, false, {Ball<kDim>{center, 0.2}}).empty());
    EXPECT_TRUE(crossings_of<kDim>(scene, false, {Ball<kDim>{center, 0.05}}).empty());
}

TYPED_TEST(CrossingsTest, WithObstaclesAreNoneOfBodiesThatAreMovedFromOutside) {
    constexpr int kDim = TypeParam::value;
    test::Scene<kDim> scene;
    scene.add(test::cube<kDim>(1), Vector<kDim>::Zero());
    for (const bool is_kinematic : {false, true}) {
        for (const ObstacleShape<kDim>& obstacle :
             {ObstacleShape<kDim>(HalfSpace<kDim>{Vector<kDim>::Unit(1), 0.5}),
              ObstacleShape<kDim>(Ball<kDim>{Vector<kDim>::Zero(), 0.2})}) {
            ContactScene<kDim> model = scene_of<kDim>(scene, false, {obstacle});
            model.bodies[0].is_kinematic = is_kinematic;
            EXPECT_EQ(ContactFinder<kDim>(model).find_crossings(scene.positions).empty(),
                      is_kinematic);
        }
    }
}

// Larger than the ball or the box, and around them without touching.
TYPED_TEST(CrossingsTest, WithAnObstacleThatABodyHasSwallowedAreReported) {
    constexpr int kDim = TypeParam::value;
    test::Scene<kDim> scene;
    scene.add(test::cube<kDim>(3), Vector<kDim>::Zero());
    const Vector<kDim> middle = Vector<kDim>::Constant(1.4);
    for (const ObstacleShape<kDim>& obstacle :
         {ObstacleShape<kDim>(Ball<kDim>{middle, 0.5}),
          ObstacleShape<kDim>(Cuboid<kDim>{middle, Vector<kDim>::Constant(0.9)})}) {
        const std::vector<Crossing> crossings = crossings_of<kDim>(scene, false, {obstacle});
        ASSERT_EQ(crossings.size(), 1U);
        EXPECT_EQ(describe<kDim>(crossings[0], scene_of<kDim>(scene)), "obstacle 1 is inside 'a'");
    }
}

TYPED_TEST(CrossingsTest, WithABoxAreWhereFacesMeetOrVerticesAreInside) {
    constexpr int kDim = TypeParam::value;
    test::Scene<kDim> scene;
    scene.add(test::cube<kDim>(1), Vector<kDim>::Zero());
    const auto at = [&](double x, double side) {
        Vector<kDim> center = Vector<kDim>::Constant(0.53);
        center[0] = x;
        return crossings_of<kDim>(scene, false,
                                  {Cuboid<kDim>{center, Vector<kDim>::Constant(side)}});
    };
    EXPECT_TRUE(at(-0.3, 0.4).empty());
    const std::vector<Crossing> cut = at(-0.1, 0.4);  // between the vertices of the cube
    EXPECT_GT(count(cut, CrossingKind::Through), 0);
    for (const Crossing& crossing : cut) {  // the body first, whichever's edge it is
        EXPECT_FALSE(crossing.first.is_obstacle());
        EXPECT_FALSE(crossing.first_corners.empty());
        for (const std::uint32_t corner : crossing.first_corners) {
            EXPECT_LT(corner, scene.positions.cols());
        }
        EXPECT_TRUE(crossing.second.is_obstacle());
        EXPECT_TRUE(crossing.second_corners.empty());
    }
    EXPECT_EQ(count(at(0.5, 3), CrossingKind::Inside), 1 << kDim);
}

// They may lie where the scene has put them, with a corner of a box among their cells; what goes
// through another body is reported all the same, as is what one vertex that is free does.
TYPED_TEST(CrossingsTest, OfFixedVerticesAreTouchesOfNothingAndMayBeInObstacles) {
    constexpr int kDim = TypeParam::value;
    const auto is_free_of_crossings = [](const ContactScene<kDim>& model,
                                         const Positions<kDim>& positions) {
        return ContactFinder<kDim>(model).find_crossings(positions).empty();
    };
    test::Scene<kDim> scene;
    scene.add(test::cube<kDim>(1), Vector<kDim>::Zero());
    scene.add(test::cube<kDim>(1), Vector<kDim>::Unit(0));
    ContactScene<kDim> model = scene_of<kDim>(scene);
    EXPECT_FALSE(is_free_of_crossings(model, scene.positions));
    model.is_fixed.assign(model.is_fixed.size(), true);
    EXPECT_TRUE(is_free_of_crossings(model, scene.positions));
    model.is_fixed[model.is_fixed.size() / 2] = false;  // the first of the second, at the first
    EXPECT_FALSE(is_free_of_crossings(model, scene.positions));
    model.is_fixed.assign(model.is_fixed.size(), true);
    scene.body(1).row(0).array() -= 0.1;
    test::shake<kDim>(scene.positions, 0.05, 2);
    EXPECT_FALSE(is_free_of_crossings(model, scene.positions));
    test::Scene<kDim> one;
    one.add(test::cube<kDim>(1), Vector<kDim>::Zero());
    Vector<kDim> center = Vector<kDim>::Constant(0.53);
    center[0] = -0.1;
    for (const ObstacleShape<kDim>& obstacle :
         {ObstacleShape<kDim>(Cuboid<kDim>{center, Vector<kDim>::Constant(0.4)}),
          ObstacleShape<kDim>(Ball<kDim>{Vector<kDim>::Zero(), 0.2})}) {
        ContactScene<kDim> with = scene_of<kDim>(one, false, {obstacle});
        EXPECT_FALSE(is_free_of_crossings(with, one.positions));
        with.is_fixed.assign(with.is_fixed.size(), true);
        EXPECT_TRUE(is_free_of_crossings(with, one.positions));
    }
}

// Of all kinds: through another body and an obstacle, inside an obstacle, and around one.
TYPED_TEST(CrossingsTest, AreTheFirstOfAllIfNotAllAreAskedFor) {
    constexpr int kDim = TypeParam::value;
    test::Scene<kDim> scene;
    scene.add(test::cube<kDim>(1), Vector<kDim>::Zero());
    scene.add(test::cube<kDim>(1), Vector<kDim>::Constant(0.3));
    scene.add(test::cube<kDim>(3), Vector<kDim>::Constant(9));
    test::shake<kDim>(scene.positions, 0.05, 2);
    const ContactScene<kDim> model =
        scene_of<kDim>(scene, false,
                       {HalfSpace<kDim>{Vector<kDim>::Unit(1), 0.5},
                        Ball<kDim>{Vector<kDim>::Constant(10.4), 0.5}});
    const ContactFinder<kDim> finder(model);
    const std::vector<Crossing> all = finder.find_crossings(scene.positions, 100000);
    ASSERT_GT(count(all, CrossingKind::Through), 0);
    EXPECT_GT(count(all, CrossingKind::Inside), (1 << kDim) / 2);
    EXPECT_EQ(std::count_if(all.begin(), all.end(),
                            [](const Crossing& c) { return c.first_corners.empty(); }),
              1);
    for (std::size_t most = 0; most <= all.size(); most += most < all.size() - 30 ? 29 : 1) {
        const std::vector<Crossing> some = finder.find_crossings(scene.positions, most);
        ASSERT_EQ(some.size(), most);
        for (std::size_t i = 0; i < most; ++i) {
            EXPECT_EQ(describe<kDim>(some[i], model), describe<kDim>(all[i], model));
        }
    }
}

TYPED_TEST(CrossingsTest, SweepOfTheCheckerSeesWhatPassesWithinAStep) {
    constexpr int kDim = TypeParam::value;
    test::Scene<kDim> scene;
    scene.add(test::cube<kDim>(1), Vector<kDim>::Zero());
    Vector<kDim> before = Vector<kDim>::Constant(0.1);
    before[0] = -1.5;
    scene.add(test::cube<kDim>(1), before);
    test::shake<kDim>(scene.positions, 0.01, 8);
    const auto swept = [&](double distance) {
        Positions<kDim> to = scene.positions;
        to.rightCols(to.cols() / 2).row(0).array() += distance;
        return pent::test::count_swept_crossings<kDim>(scene.surfaces[0], scene.surfaces[1],
                                                       scene.positions, to);
    };
    EXPECT_EQ(swept(0.4), 0);
    EXPECT_GT(swept(5), 0);  // free of crossings at the start and at the end
}

}  // namespace
}  // namespace pent::contact
