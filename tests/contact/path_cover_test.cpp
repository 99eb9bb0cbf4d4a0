#include "path_cover.h"

#include "scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace pent::contact {
namespace {

template <typename T>
class PathCoverTest : public testing::Test {
protected:
    static constexpr int kD = T::value;

    void SetUp() override {
        scene_.add(test::cube<kD>(1), Vector<kD>::Zero());
        from_ = scene_.positions;
        to_ = test::tilt<kD>() * from_;
        to_.row(0).array() += 5;  // mostly a shift
        inflation_.setConstant(from_.cols(), kInflation);
        const PositionsView<kD> from = from_;
        const PositionsView<kD> to = to_;
        cover_ = PathCover<kD>(vertices(), {.from = from, .to = to, .inflation = &inflation_});
    }

    static constexpr double kInflation = 0.05;
    [[nodiscard]] const Simplices<1>& vertices() const { return scene_.surfaces[0].vertices; }
    [[nodiscard]] Displacement displacement(const Positions<kD>& from,
                                            const Positions<kD>& to) const {
        Displacement displacement(vertices(), vertices());
        cover_.find_displacement(from, to, displacement);
        return displacement;
    }

    test::Scene<kD> scene_;
    Positions<kD> from_;
    Positions<kD> to_;
    Eigen::VectorXd inflation_;
    PathCover<kD> cover_;
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(PathCoverTest, Dimensions);

TYPED_TEST(PathCoverTest, HoldsAllThatIsOnTheWayButForAShiftOfAll) {
    constexpr int kDim = TypeParam::value;
    for (const double t : {0.0, 0.3, 1.0}) {
        Positions<kDim> x = (1 - t) * this->from_ + t * this->to_;
        x.colwise() += 100 * Vector<kDim>::Ones();
        EXPECT_TRUE(this->cover_.covers(x));
        x(0, 0) += 2 * TestFixture::kInflation;  // less what moves the mean and the time
        EXPECT_FALSE(this->cover_.covers(x));
    }
}

// Two vertices come nearer by no more than their displacements together.
TYPED_TEST(PathCoverTest, DisplacementsBoundHowDistancesChange) {
    constexpr int kDim = TypeParam::value;
    Positions<kDim> x = this->to_;
    test::shake<kDim>(x, 0.1, 4);
    x.row(1).array() -= 3;
    const Displacement displacement = this->displacement(this->to_, x);
    EXPECT_LT(displacement.max, 0.5F);  // the shift is no part of them
    float most = 0;
    for (const std::uint32_t i : this->vertices().reshaped()) {
        most = std::max(most, displacement[i]);
        for (const std::uint32_t j : this->vertices().reshaped()) {
            if (i == j) {
                continue;
            }
            const double change =
                (x.col(i) - x.col(j)).norm() - (this->to_.col(i) - this->to_.col(j)).norm();
            EXPECT_LE(std::abs(change),
                      static_cast<double>(displacement[i]) + static_cast<double>(displacement[j]));
        }
    }
    EXPECT_EQ(displacement.max, most);
}

TYPED_TEST(PathCoverTest, DisplacementsOnAWayAreThoseOfItsFartherEnds) {
    constexpr int kDim = TypeParam::value;
    const auto displacements = [&](const Positions<kDim>& from, const Positions<kDim>& to) {
        const Displacement displacement = this->displacement(from, to);
        Eigen::VectorXf of_vertex(this->vertices().cols());
        for (Eigen::Index k = 0; k < of_vertex.size(); ++k) {
            of_vertex[k] = displacement[this->vertices()(0, k)];
        }
        return of_vertex;
    };
    Positions<kDim> x = this->to_;
    Positions<kDim> y = this->to_;
    test::shake<kDim>(x, 0.3, 4);
    test::shake<kDim>(y, 0.3, 5);
    const Eigen::VectorXf of_x = displacements(x, x);
    const Eigen::VectorXf of_y = displacements(y, y);
    EXPECT_TRUE((of_x.array() > of_y.array()).any());
    EXPECT_TRUE((of_x.array() < of_y.array()).any());
    EXPECT_EQ(displacements(x, y), of_x.cwiseMax(of_y));
    EXPECT_EQ(displacements(x, Positions<kDim>(x)), of_x);
}

// Of the paths themselves, where others are wanted than those of the scene.
TYPED_TEST(PathCoverTest, KnowsTheLongestPathAndWhatIsFarthestFromItsEnd) {
    constexpr int kDim = TypeParam::value;
    const double longest = longest_path<kDim>(this->vertices(), this->from_, this->to_);
    EXPECT_NEAR(this->cover_.longest_path(), longest, 1e-12);
    EXPECT_NEAR(this->cover_.farthest_from_end(this->from_), longest, 1e-12);
    EXPECT_NEAR(this->cover_.farthest_from_end(this->to_), 0, 1e-12);
    Positions<kDim> shifted = this->to_;
    shifted.row(1).array() += 7;
    EXPECT_NEAR(this->cover_.farthest_from_end(shifted), 0, 1e-12);
    EXPECT_TRUE(this->cover_.vertices() == this->vertices());
}

}  // namespace
}  // namespace pent::contact
