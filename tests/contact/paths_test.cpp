#include "paths.h"

#include "scenes.h"

#include <gtest/gtest.h>

namespace pent::contact {
namespace {

template <typename T>
class PathsTest : public testing::Test {
protected:
    static constexpr int kD = T::value;

    void SetUp() override {
        scene_.add(test::cube<kD>(1), Vector<kD>::Zero());
        scene_.add(test::cube<kD>(1), Vector<kD>::Constant(3));
        from_ = scene_.positions;
        to_ = test::tilt<kD>() * from_;
        to_.row(0).array() += 5;  // mostly a shift
    }

    [[nodiscard]] const Simplices<1>& vertices() const { return scene_.surfaces[0].vertices; }

    test::Scene<kD> scene_;
    Positions<kD> from_;
    Positions<kD> to_;
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(PathsTest, Dimensions);

TYPED_TEST(PathsTest, ShiftsAreMeansOverSomeVertices) {
    constexpr int kDim = TypeParam::value;
    const Eigen::Index count = this->scene_.begin[1];
    const Vector<kDim> expected =
        (this->to_ - this->from_).leftCols(count).rowwise().sum() / static_cast<double>(count);
    const Vector<kDim> shift = mean_shift<kDim>(this->vertices(), this->from_, this->to_);
    EXPECT_NEAR((shift - expected).norm(), 0, 1e-12);
    EXPECT_EQ((mean_shift<kDim>(Simplices<1>(1, 0), this->from_, this->to_).norm()), 0);
}

TYPED_TEST(PathsTest, InflationGrowsWithPathsLessTheirDrift) {
    constexpr int kDim = TypeParam::value;
    const PositionsView<kDim> from = this->from_;
    const PositionsView<kDim> to = this->to_;
    const Paths<kDim> paths{from, to, mean_shift<kDim>(this->vertices(), from, to)};
    Eigen::VectorXd inflation = Eigen::VectorXd::Zero(from.cols());
    const double* place = inflation.data();
    set_inflation<kDim>(this->vertices(), paths, 1e-9, 0.25, inflation);
    const double longest = longest_path<kDim>(this->vertices(), from, to);
    EXPECT_LT(longest, 2);  // the shift is no part of it
    const Eigen::VectorXd of_first = inflation.head(this->scene_.begin[1]);
    EXPECT_NEAR(of_first.maxCoeff(), 0.25 * longest, 1e-12);
    // The least where that is more; of other vertices what it was.
    set_inflation<kDim>(this->scene_.surfaces[1].vertices, paths, 100, 0.25, inflation);
    EXPECT_EQ(inflation.tail(from.cols() - this->scene_.begin[1]).minCoeff(), 100);
    EXPECT_EQ(inflation.head(this->scene_.begin[1]), of_first);
    EXPECT_EQ(inflation.data(), place);  // other threads may read it
}

TYPED_TEST(PathsTest, InflationOfASimplexIsTheLargestOfItsCorners) {
    constexpr int kDim = TypeParam::value;
    const PositionsView<kDim> x = this->from_;
    const Eigen::VectorXd inflation =
        Eigen::VectorXd::LinSpaced(x.cols(), 0, static_cast<double>(x.cols() - 1));
    const Paths<kDim> paths{.from = x, .to = x, .inflation = &inflation};
    EXPECT_TRUE(paths.is_still());
    const Simplices<kDim>& facets = this->scene_.surfaces[0].facets;
    for (Eigen::Index f = 0; f < facets.cols(); ++f) {
        EXPECT_EQ((paths.template inflation_of<kDim>(facets, f)), facets.col(f).maxCoeff());
    }
    EXPECT_EQ((Paths<kDim>{x, x}.template inflation_of<kDim>(facets, 0)), 0);
}

}  // namespace
}  // namespace pent::contact
