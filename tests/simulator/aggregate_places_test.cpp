#include "linear/aggregate_places.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pent::simulator {
namespace {

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;

template <typename T>
class AggregatePlacesTest : public testing::Test {
protected:
    static constexpr int kDim = T::value;
    static constexpr std::uint32_t kVertices = 40;

    AggregatePlacesTest() {
        std::mt19937 random(3);
        std::normal_distribution<double> place(1, 2);
        vertices_ = Positions<kDim>::NullaryExpr(kDim, kVertices, [&] { return place(random); });
        below_ = aggregates(kVertices, 9);
        above_ = aggregates(9, 2);
    }

    // Of which each has every so manieth child.
    static Aggregates aggregates(std::uint32_t children, std::uint32_t count) {
        std::vector<std::uint32_t> of_child;
        for (std::uint32_t child = 0; child < children; ++child) {
            of_child.push_back(child % count);
        }
        return {std::move(of_child), count};
    }

    [[nodiscard]] AggregatePlaces<kDim> children() const {
        return places_of(workers_, below_, ChildPlaces<kDim>(vertices_));
    }

    const Workers workers_ = Workers(2);
    Positions<kDim> vertices_;
    Aggregates below_;
    Aggregates above_;
};
TYPED_TEST_SUITE(AggregatePlacesTest, Dimensions);

// However many levels lie between.
TYPED_TEST(AggregatePlacesTest, AreMeansAndSpreadsOfTheVertices) {
    const auto children = this->children();
    const ChildPlaces<TestFixture::kDim> of_children(children);
    const auto places = places_of(this->workers_, this->above_, of_children);
    for (std::uint32_t a = 0; a < 2; ++a) {
        std::vector<Eigen::Index> own;
        for (std::uint32_t vertex = 0; vertex < TestFixture::kVertices; ++vertex) {
            if (this->above_.of_child()[this->below_.of_child()[vertex]] == a) {
                own.push_back(vertex);
            }
        }
        const auto points = this->vertices_(Eigen::all, own).eval();
        const auto middle = points.rowwise().mean().eval();
        const double spread = (points.colwise() - middle).colwise().squaredNorm().mean();
        EXPECT_NEAR((places.middles.col(a) - middle).norm(), 0, 1e-14);
        EXPECT_NEAR(places.sizes[a], std::sqrt(spread), 1e-14);
        EXPECT_EQ(places.counts[a], static_cast<double>(own.size()));
    }
}

TYPED_TEST(AggregatePlacesTest, ArmsLeadFromTheMiddleToTheChildren) {
    const auto children = this->children();
    const ChildPlaces<TestFixture::kDim> of_children(children);
    const auto places = places_of(this->workers_, this->above_, of_children);
    const auto arms = arms_of(this->workers_, this->above_, of_children, places, nullptr);
    ASSERT_EQ(arms.size(), 9U);
    for (std::uint32_t child = 0; child < 9; ++child) {
        const std::uint32_t a = this->above_.of_child()[child];
        EXPECT_NEAR(
            (places.middles.col(a) + places.sizes[a] * arms[child].x - children.middles.col(child))
                .norm(),
            0, 1e-14);
        EXPECT_NEAR(arms[child].ratio * places.sizes[a], children.sizes[child], 1e-14);
    }
}

// An aggregate of one vertex has no size to measure by.
TYPED_TEST(AggregatePlacesTest, ArmOfAVertexAloneIsZero) {
    const Aggregates alone = TestFixture::aggregates(TestFixture::kVertices, 40);
    const ChildPlaces<TestFixture::kDim> vertices(this->vertices_);
    const auto places = places_of(this->workers_, alone, vertices);
    for (const auto& arm : arms_of(this->workers_, alone, vertices, places, nullptr)) {
        EXPECT_EQ(arm.x.norm(), 0);
        EXPECT_EQ(arm.ratio, 0);
    }
}

}  // namespace
}  // namespace pent::simulator
