#include "pair_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

// Share of an edge over the middle of a ridge, each seen by the other from the front: 0 where they
// are no contact. The ridge is regular, in the plane of the first axes, and the edge as long as its
// sides, turned by an angle out of that plane.
//
// @param aside  How far the middle of the edge is beside that of the ridge, in sides.
template <int Dim>
double share_at(double angle, double aside = 0, double side = 1) {
    constexpr int kLast = Dim - 1;
    Positions<Dim> positions = Positions<Dim>::Zero(Dim, Dim + 1);
    Positions<Dim> normals = Positions<Dim>::Zero(Dim, Dim + 1);
    normals.row(kLast) << -1, -1, Eigen::RowVectorXd::Ones(Dim - 1);
    if constexpr (Dim == 3) {
        positions.rightCols(2).row(0) << -0.5, 0.5;
    } else {
        positions.rightCols(3).row(0) << -0.5, 0.5, 0;
        positions.rightCols(3).row(1) << -std::sqrt(3) / 6, -std::sqrt(3) / 6, std::sqrt(3) / 3;
    }
    const Vector<Dim> half = std::cos(angle) / 2 * Vector<Dim>::Unit(0)
                             + std::sin(angle) / 2 * Vector<Dim>::Unit(Dim - 2);
    positions.col(0) = -half;
    positions.col(1) = half;
    positions.leftCols(2).row(Dim - 2).array() += aside;
    positions.leftCols(2).row(kLast).setConstant(0.05);
    positions *= side;
    const auto simplex = [](auto count, std::uint32_t first) {
        return Simplices<count.value>(Simplices<count.value>::NullaryExpr(
            count.value, 1,
            [=](Eigen::Index i, Eigen::Index) { return first + static_cast<std::uint32_t>(i); }));
    };
    const PositionsView<Dim> view = positions;
    const PairSetting<Dim> setting{view,       positions, normals,
                                   0.1 * side, {},        {Collider::Kind::Body, 1}};
    const auto contact =
        local_contact<Dim, 2, Dim - 1>(setting, simplex(std::integral_constant<int, 2>(), 0), 0,
                                       simplex(std::integral_constant<int, Dim - 1>(), 2), 0);
    return contact ? contact->share : 0;
}

template <typename T>
class MixedContact : public testing::Test {};
TYPED_TEST_SUITE(MixedContact, Dimensions);

TYPED_TEST(MixedContact, FadesWithTheSquareOfTheSineAndIsNoneWhereParallel) {
    constexpr int kDim = TypeParam::value;
    for (const double side : {1e-4, 1.0, 1e4}) {
        for (const double angle : {0.25, 0.5, 1.0, 1.57}) {
            EXPECT_EQ(share_at<kDim>(angle, 0, side), 1);
        }
        for (const double sine : {-0.15, 0.1, 0.02, 1e-4}) {
            const double part = 25 * sine * sine;
            EXPECT_NEAR(share_at<kDim>(std::asin(sine), 0, side), part * (2 - part), 1e-12 * part)
                << sine;
        }
        EXPECT_EQ(share_at<kDim>(0, 0, side), 0);
    }
}

// Nearly parallel ones that are a little beside each other are nearest far from their middles, and
// a slight turn leads that point along both.
TYPED_TEST(MixedContact, ChangesLittleInASlightTurnThroughParallel) {
    constexpr int kDim = TypeParam::value;
    constexpr double kAside = 0.005;
    constexpr double kTurn = 1e-4;
    // By the sine the share changes by 7.7 at most. The point moves by aside / sine^2 sides, which
    // changes a weight by not much more, and the share by 6 times that and 50 sine^2.
    constexpr double kMost = 7.7 + 1.2 * 6 * 50 * kAside;
    double last = share_at<kDim>(-0.3, kAside);
    double most = last;
    for (int k = 1; k <= 6000; ++k) {
        const double share = share_at<kDim>(-0.3 + k * kTurn, kAside);
        ASSERT_LE(std::abs(share - last), kMost * kTurn) << k;
        last = share;
        most = std::max(most, share);
    }
    EXPECT_GT(most, 0.9);
}

}  // namespace
}  // namespace pent::contact
