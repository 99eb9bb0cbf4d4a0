#include "pair_contact.h"

#include <gtest/gtest.h>

#include <type_traits>

namespace pent::contact {
namespace {

// A point over a facet whose corners are the origin and, on each axis but the last, the point
// `size` m along.
template <int Dim>
std::optional<Contact<Dim>> contact_at(double height, double size, bool is_inside = false) {
    Positions<Dim> positions = Positions<Dim>::Zero(Dim, Dim + 1);
    positions(Dim - 1, 0) = height;
    for (int axis = 0; axis + 1 < Dim; ++axis) {
        positions(axis, 0) = size / (2 * Dim);
        positions(axis, axis + 2) = size;
    }
    const Simplices<Dim> facets = Simplices<Dim>::NullaryExpr(
        Dim, 1,
        [](Eigen::Index i, Eigen::Index /*j*/) { return static_cast<std::uint32_t>(i + 1); });
    const PositionsView<Dim> view = positions;
    const PairSetting<Dim> setting{view, positions, positions, 0.1, {}, {Collider::Kind::Body, 1}};
    return solid_contact<Dim>(setting, 0, facets, 0, is_inside);
}

template <typename T>
class SolidContact : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(SolidContact, Dimensions);

TYPED_TEST(SolidContact, IsOfPointsWithinTheDistanceAndOfAllInside) {
    constexpr int kDim = TypeParam::value;
    ASSERT_TRUE(contact_at<kDim>(0.05, 1));
    EXPECT_NEAR(contact_at<kDim>(0.05, 1)->distance, 0.05, 1e-15);
    EXPECT_FALSE(contact_at<kDim>(0.11, 1));
    ASSERT_TRUE(contact_at<kDim>(-0.4, 1, true));
    EXPECT_NEAR(contact_at<kDim>(-0.4, 1, true)->distance, -0.4, 1e-15);
}

TYPED_TEST(SolidContact, OnAFacetPushesAlongItsNormal) {
    constexpr int kDim = TypeParam::value;
    ASSERT_TRUE(contact_at<kDim>(0, 1));
    const Vector<kDim> direction = contact_at<kDim>(0, 1)->direction;
    EXPECT_NEAR(direction.norm(), 1, 1e-15);
    EXPECT_NEAR(std::abs(direction[kDim - 1]), 1, 1e-15);
}

TYPED_TEST(SolidContact, OnAFacetThatHasCollapsedHasNoDirectionAndIsNone) {
    EXPECT_FALSE(contact_at<TypeParam::value>(0, 0));
}

}  // namespace
}  // namespace pent::contact
