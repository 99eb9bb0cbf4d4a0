#include "obstacle_contacts.h"

#include "two_cubes.h"

#include <gtest/gtest.h>

namespace pent::contact {
namespace {

template <typename T>
class ObstacleContactsTest : public testing::Test {
protected:
    static std::vector<ObstacleShape<T::value>> obstacles() {
        const Vector<T::value> up = Vector<T::value>::Unit(1);
        return {HalfSpace<T::value>{up, 0.1}, Ball<T::value>{Vector<T::value>::Zero(), 0.4}};
    }

    test::TwoCubes<T::value> cubes_;
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(ObstacleContactsTest, Dimensions);

TYPED_TEST(ObstacleContactsTest, OfAPenaltyAreAllVerticesWithinTheDistanceOfEachObstacle) {
    constexpr int kDim = TypeParam::value;
    this->cubes_.options.model = ContactModel::Penalty;
    ContactScene<kDim> model = this->cubes_.model(this->obstacles());
    model.obstacles[1].distance = 0.7;
    model.is_fixed[3] = true;
    const Colliders<kDim> colliders(model);
    const Positions<kDim>& x = this->cubes_.scene.positions;
    const std::vector<std::uint32_t> vertices = vertices_at_obstacles(colliders);
    EXPECT_EQ(vertices.size(), static_cast<std::size_t>(x.cols()) - 1);
    const auto found = find_obstacle_contacts<kDim>(colliders, vertices, x);
    std::size_t next = 0;
    for (std::uint32_t o = 0; o < 2; ++o) {
        for (const std::uint32_t vertex : vertices) {
            const auto at = signed_distance<kDim>(model.obstacles[o].shape, x.col(vertex));
            if (at.value >= model.obstacles[o].distance) {
                continue;
            }
            ASSERT_LT(next, found.size());
            const Contact<kDim>& contact = found[next++];
            EXPECT_EQ(contact.vertices[0], vertex);
            EXPECT_EQ(contact.distance, at.value);
            EXPECT_EQ(contact.direction, at.gradient);
            EXPECT_EQ(contact.weights[0], 1);
            EXPECT_EQ(contact.count, 1);
            EXPECT_EQ(contact.first.index, vertex < this->cubes_.scene.begin[1] ? 0U : 1U);
            EXPECT_EQ(contact.second, (Collider{Collider::Kind::Obstacle, o}));
        }
    }
    EXPECT_EQ(next, found.size());
    EXPECT_GT(found.size(), 4U);
}

TYPED_TEST(ObstacleContactsTest, OfABarrierAreThoseOfObstaclesThatRepelVertices) {
    constexpr int kDim = TypeParam::value;
    ContactScene<kDim> model = this->cubes_.model(this->obstacles());
    model.bodies[1].is_kinematic = true;
    const Colliders<kDim> colliders(model);
    EXPECT_TRUE(meets_vertices(colliders, 0));
    EXPECT_FALSE(meets_vertices(colliders, 1));
    const std::vector<std::uint32_t> vertices = vertices_at_obstacles(colliders);
    EXPECT_EQ(vertices.size(), static_cast<std::size_t>(this->cubes_.scene.begin[1]));
    // Of fixed ones those that are let go again.
    model.is_fixed[2] = model.is_fixed[3] = true;
    model.is_always_fixed = model.is_fixed;
    model.is_always_fixed[2] = false;
    std::vector<std::uint32_t> others = vertices;
    std::erase(others, 3U);
    std::vector<std::uint32_t> found_again = vertices_at_obstacles(Colliders<kDim>(model));
    EXPECT_EQ(found_again, others);
    // Without shakes the lowest are as near as they are pushed: within the distance and the
    // separation, 0.21, or not.
    for (const double height : {0.195, 0.205, 0.215}) {
        Positions<kDim> x = this->cubes_.rest;
        x.row(1).array() += 0.1 + height;
        const auto found = find_obstacle_contacts<kDim>(colliders, vertices, x);
        EXPECT_EQ(found.size(), height < 0.21 ? vertices.size() / 2 : 0U);
        for (const Contact<kDim>& contact : found) {
            EXPECT_EQ(contact.second.index, 0U);
            EXPECT_NEAR(contact.distance, height, 1e-14);
        }
    }
}

}  // namespace
}  // namespace pent::contact
