#include "path_cover.h"

#include "scenes.h"

#include <gtest/gtest.h>

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
        cover_.set(vertices(), from_, to_, kInflation, 0);
    }

    static constexpr double kInflation = 0.05;
    [[nodiscard]] const Simplices<1>& vertices() const { return scene_.surfaces[0].vertices; }

    test::Scene<kD> scene_;
    Positions<kD> from_;
    Positions<kD> to_;
    PathCover<kD> cover_;
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(PathCoverTest, Dimensions);

TYPED_TEST(PathCoverTest, HoldsAllThatIsOnTheWayButForAShiftOfAll) {
    constexpr int kDim = TypeParam::value;
    for (const double t : {0.0, 0.3, 1.0}) {
        Positions<kDim> x = (1 - t) * this->from_ + t * this->to_;
        x.colwise() += 100 * Vector<kDim>::Ones();
        EXPECT_TRUE(this->cover_.covers(this->vertices(), x));
        x(0, 0) += 2 * TestFixture::kInflation;  // less what moves the mean and the time
        EXPECT_FALSE(this->cover_.covers(this->vertices(), x));
    }
    EXPECT_FALSE(PathCover<kDim>().covers(this->vertices(), this->from_));
}

// Two vertices come nearer by no more than their displacements together.
TYPED_TEST(PathCoverTest, DisplacementsBoundHowDistancesChange) {
    constexpr int kDim = TypeParam::value;
    Positions<kDim> x = this->to_;
    test::shake<kDim>(x, 0.1, 4);
    x.row(1).array() -= 3;
    Eigen::VectorXf of_vertex(x.cols());
    const float max = this->cover_.displacement(this->vertices(), this->to_, x, of_vertex);
    EXPECT_EQ(max, of_vertex.maxCoeff());
    EXPECT_LT(max, 0.5F);  // the shift is no part of them
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
        for (Eigen::Index j = 0; j < i; ++j) {
            const double change =
                (x.col(i) - x.col(j)).norm() - (this->to_.col(i) - this->to_.col(j)).norm();
            EXPECT_LE(std::abs(change),
                      static_cast<double>(of_vertex[i]) + static_cast<double>(of_vertex[j]));
        }
    }
}

TYPED_TEST(PathCoverTest, InflationGrowsWithPathsLessTheirShift) {
    constexpr int kDim = TypeParam::value;
    PathCover<kDim> cover;
    cover.set(this->vertices(), this->from_, this->to_, 1e-9, 0.25);
    const double longest = longest_path<kDim>(this->vertices(), this->from_, this->to_);
    EXPECT_NEAR(cover.inflation().maxCoeff(), 0.25 * longest, 1e-12);
    EXPECT_LT(longest, 2);
}

}  // namespace
}  // namespace pent::contact
