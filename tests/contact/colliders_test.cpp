#include "colliders.h"

#include "two_cubes.h"

#include <gtest/gtest.h>

namespace pent::contact {
namespace {

template <typename T>
class CollidersTest : public testing::Test {
protected:
    // A half-space, a ball, and a box.
    [[nodiscard]] ContactScene<T::value> model(ContactModel model) {
        cubes_.options.model = model;
        const Vector<T::value> center = cubes_.below(0.5);
        return cubes_.model({HalfSpace<T::value>{Vector<T::value>::Unit(1), -1},
                             Ball<T::value>{center, 0.2},
                             Cuboid<T::value>{center, Vector<T::value>::Constant(0.3)}});
    }

    test::TwoCubes<T::value> cubes_;
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(CollidersTest, Dimensions);

TYPED_TEST(CollidersTest, AreBodiesAndUnderABarrierTheCoresOfObstaclesThatRepelFacets) {
    constexpr int kDim = TypeParam::value;
    const ContactScene<kDim> soft = this->model(ContactModel::Penalty);
    EXPECT_EQ(Colliders<kDim>(soft).count(), 2);
    const ContactScene<kDim> hard = this->model(ContactModel::Barrier);
    const Colliders<kDim> colliders(hard);
    ASSERT_EQ(colliders.count(), 4);
    EXPECT_EQ(colliders.collider(1), (Collider{Collider::Kind::Body, 1}));
    EXPECT_EQ(colliders.collider(2), (Collider{Collider::Kind::Obstacle, 1}));
    EXPECT_EQ(colliders.collider(3), (Collider{Collider::Kind::Obstacle, 2}));
    EXPECT_EQ(colliders.radius(1), 0);
    EXPECT_EQ(colliders.radius(2), 0.2);
    EXPECT_EQ(colliders.surface(2).vertices.cols(), 1);
    EXPECT_EQ(colliders.surface(3).vertices.cols(), 1 << kDim);
}

TYPED_TEST(CollidersTest, DoNotMeetWhereTheyAreToIgnoreEachOther) {
    constexpr int kDim = TypeParam::value;
    for (const ContactModel model : {ContactModel::Penalty, ContactModel::Barrier}) {
        ContactScene<kDim> scene = this->model(model);
        scene.options.self = true;
        scene.ignored = {{0, 1}, {1, 1}};
        const Colliders<kDim> colliders(scene);
        EXPECT_FALSE(colliders.can_meet(0, 1));
        EXPECT_FALSE(colliders.can_meet(1, 0));
        EXPECT_FALSE(colliders.can_meet(1, 1));
        EXPECT_TRUE(colliders.can_meet(0, 0));
        EXPECT_EQ(colliders.count() > 2, model == ContactModel::Barrier);
        for (int core = 2; core < colliders.count(); ++core) {
            EXPECT_TRUE(colliders.can_meet(1, core));
        }
    }
}

TYPED_TEST(CollidersTest, HaveTheVerticesOfCoresBehindThoseOfTheScene) {
    constexpr int kDim = TypeParam::value;
    const ContactScene<kDim> model = this->model(ContactModel::Barrier);
    const Colliders<kDim> colliders(model);
    const Positions<kDim>& x = this->cubes_.scene.positions;
    const auto first = static_cast<std::uint32_t>(x.cols());
    EXPECT_EQ(colliders.surface(2).vertices(0, 0), first);
    EXPECT_EQ(colliders.surface(3).vertices(0, 0), first + 1);
    EXPECT_EQ(colliders.surface(3).facets.minCoeff(), first + 1);
    EXPECT_FALSE(colliders.is_fixed(first - 1));
    EXPECT_TRUE(colliders.is_fixed(first));
    const Positions<kDim> all = colliders.with_cores(
        x, [](const PositionsView<kDim>& view) { return Positions<kDim>(view); });
    ASSERT_EQ(all.cols(), x.cols() + 1 + (1 << kDim));
    EXPECT_EQ(all.leftCols(x.cols()), x);
    EXPECT_EQ(all.col(x.cols()), this->cubes_.below(0.5));
    EXPECT_EQ(colliders.rest().rightCols(1 + (1 << kDim)), all.rightCols(1 + (1 << kDim)));
}

TYPED_TEST(CollidersTest, MeetWhereAnythingIsToBeKnownOfThem) {
    constexpr int kDim = TypeParam::value;
    for (const ContactModel which : {ContactModel::Penalty, ContactModel::Barrier}) {
        const bool is_barrier = which == ContactModel::Barrier;
        ContactScene<kDim> model = this->model(which);
        const Colliders<kDim> colliders(model);
        EXPECT_TRUE(colliders.can_meet(0, 1));
        EXPECT_FALSE(colliders.can_meet(0, 0));
        model.options.self = true;
        EXPECT_TRUE(colliders.can_meet(0, 0));
        model.bodies[0].is_kinematic = true;
        EXPECT_TRUE(colliders.can_meet(0, 1));
        EXPECT_EQ(colliders.can_meet(0, 0), is_barrier);
        model.bodies[1].is_kinematic = true;  // a barrier does not lead them through each other
        EXPECT_EQ(colliders.can_meet(0, 1), is_barrier);
        if (is_barrier) {
            EXPECT_FALSE(colliders.can_meet(0, 2));
            EXPECT_FALSE(colliders.can_meet(2, 3));
            EXPECT_FALSE(colliders.can_meet(2, 2));
            model.bodies[1].is_kinematic = false;
            EXPECT_TRUE(colliders.can_meet(1, 2));
        }
    }
}

TYPED_TEST(CollidersTest, BodiesHaveTheirVerticesOneAfterTheOther) {
    constexpr int kDim = TypeParam::value;
    const ContactScene<kDim> model = this->cubes_.model();
    const auto second = static_cast<std::uint32_t>(this->cubes_.scene.begin[1]);
    EXPECT_EQ(body_of<kDim>(model, 0).index, 0U);
    EXPECT_EQ(body_of<kDim>(model, second - 1).index, 0U);
    EXPECT_EQ(body_of<kDim>(model, second).index, 1U);
}

}  // namespace
}  // namespace pent::contact
