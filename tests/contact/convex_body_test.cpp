#include "convex_body.h"

#include "bodies.h"
#include "closest_points_oracle.h"
#include "gather.h"
#include "overlaps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace pent::contact {
namespace {

template <typename T>
class ConvexBodyTest : public testing::Test {
protected:
    static constexpr int kSpace = T::value;

    // Behind another body, so that its vertices do not begin at 0.
    void add(SimplexMesh<kSpace> mesh) {
        scene_ = {};
        scene_.add(test::cube<kSpace>(1), Vector<kSpace>::Constant(-20));
        mesh_ = std::move(mesh);
        scene_.add(mesh_, Vector<kSpace>::Constant(3));
        mesh_.cells.array() += static_cast<std::uint32_t>(scene_.begin[1]);
    }

    [[nodiscard]] const Surface<kSpace>& surface() const { return scene_.surfaces[1]; }

    [[nodiscard]] std::optional<ConvexBody<kSpace>> make(double distance) const {
        return ConvexBody<kSpace>::make(
            {mesh_.cells.data(), static_cast<std::size_t>(mesh_.cells.size())}, scene_.positions,
            distance);
    }

    // No more than the distance.
    template <int K, int L>
    static double box_gap(const Corners<kSpace, K>& a, const Corners<kSpace, L>& b) {
        const Vector<kSpace> before = b.rowwise().minCoeff() - a.rowwise().maxCoeff();
        const Vector<kSpace> behind = a.rowwise().minCoeff() - b.rowwise().maxCoeff();
        return before.cwiseMax(behind).cwiseMax(0).norm();
    }

    template <int K, int L>
    [[nodiscard]] double least_distance(const Positions<kSpace>& x) const {
        const Simplices<K>& first = surface().template simplices<K>();
        const Simplices<L>& second = surface().template simplices<L>();
        double least = 1e9;
        for (std::uint32_t i = 0; i < first.cols(); ++i) {
            const Corners<kSpace, K> a = gather<kSpace, K>(first, i, x);
            for (std::uint32_t j = 0; j < second.cols(); ++j) {
                const Corners<kSpace, L> b = gather<kSpace, L>(second, j, x);
                if (!share_a_vertex<K, L>(first, i, second, j) && box_gap(a, b) < least) {
                    least = std::min(
                        least,
                        std::sqrt(test::closest_points<kSpace, K, L>(a, b).distance_squared));
                }
            }
        }
        return least;
    }

    // Of all pairs, by looking at each.
    [[nodiscard]] double least_distance(const Positions<kSpace>& x) const {
        return std::min(least_distance<1, kSpace>(x), least_distance<2, kSpace - 1>(x));
    }

    // The body turned, moved, stretched, bent and shaken; what is not of it stays.
    [[nodiscard]] Positions<kSpace> deformed(double amount, unsigned seed) const {
        Positions<kSpace> x = scene_.positions;
        auto body = x.rightCols(mesh_.vertex_count());
        body.row(0) *= 1 + amount;
        body.row(1) *= 1 - 0.4 * amount;
        if (amount > 0) {
            const Vector<kSpace> middle = body.rowwise().mean();
            body.colwise() -= middle;
            const double radius = 1.5 / amount;
            for (auto at : body.colwise()) {
                const double angle = at[2] / radius;
                const double r = radius - at[1];
                at[1] = radius - r * std::cos(angle);
                at[2] = r * std::sin(angle);
            }
        }
        Positions<kSpace> shaken = body;
        test::shake<kSpace>(shaken, 0.1 * amount, seed);
        body = (test::tilt<kSpace>() * shaken).colwise() + Vector<kSpace>::Constant(5 * amount);
        return x;
    }

    test::Scene<kSpace> scene_;
    SimplexMesh<kSpace> mesh_;
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(ConvexBodyTest, Dimensions);

// The law, by looking at all pairs on the way from one shape to another: what is said to stay apart
// does.
TYPED_TEST(ConvexBodyTest, WhatIsSaidToStayApartDoes) {
    constexpr int kDim = TypeParam::value;
    int said = 0;
    int not_said = 0;
    for (const SimplexMesh<kDim>& mesh : {test::cube<kDim>(2), test::ball<kDim>(2)}) {
        this->add(mesh);
        const auto body = this->make(0.12);
        ASSERT_TRUE(body);
        for (unsigned seed = 0; seed < 8; ++seed) {
            const Positions<kDim> from = this->deformed(0.05 * seed, seed);
            const Positions<kDim> to = this->deformed(0.08 * seed, seed + 100);
            double least = 1e9;
            for (const double t : {0.0, 0.3, 0.6, 1.0}) {
                least = std::min(least, this->least_distance(from + t * (to - from)));
            }
            const PositionsView<kDim> start(from);
            const PositionsView<kDim> end(to);
            for (const double distance : {0.05, 0.1, 0.2, 0.3, 0.4, 0.5}) {
                const bool is_apart = body->stays_apart({start, end}, distance);
                EXPECT_TRUE(!is_apart || least >= distance) << distance << " " << least;
                (is_apart ? said : not_said) += 1;
            }
        }
    }
    EXPECT_GT(said, 12);
    EXPECT_GT(not_said, 12);
}

// However a body is turned, moved and swollen, most of what there is to be said is, and no more:
// whether its cells tell of the gap or a search does, and where what is nearest is an edge's end
// and a ridge of one and the same facet.
TYPED_TEST(ConvexBodyTest, TurnsAndSwellingTakeNothingAway) {
    constexpr int kDim = TypeParam::value;
    SimplexMesh<kDim> uneven = test::cube<kDim>(2);
    for (auto x : uneven.positions.colwise()) {  // the middle of one side, along it
        x[0] += (x.array() == 1).count() == kDim - 1 && x[kDim - 1] == 0 ? 0.5 : 0;
    }
    const std::pair<SimplexMesh<kDim>, double> cases[] = {
        {test::cube<kDim>(2), 0.1}, {test::cube<kDim>(2), 0.35}, {uneven, 0.1}, {uneven, 0.2}};
    for (const auto& [mesh, distance] : cases) {
        this->add(mesh);
        const auto body = this->make(distance);
        ASSERT_TRUE(body);
        for (const double scale : {0.5, 1.0, 2.0}) {
            const Positions<kDim> x =
                (scale * test::tilt<kDim>() * this->scene_.positions).colwise()
                + Vector<kDim>::Ones();
            const PositionsView<kDim> view(x);
            const double least = this->least_distance(x);
            // Cells of a cube in R^4 tell of 1/2 of an edge in place of 1/sqrt(3), and the margin
            // is 1.05: 0.82.
            EXPECT_TRUE(body->stays_apart({view, view}, 0.8 * least)) << distance;
            EXPECT_FALSE(body->stays_apart({view, view}, 1.001 * least)) << distance;
        }
    }
}

// A body turned inside out, or crushed to a point, at an end of its way.
TYPED_TEST(ConvexBodyTest, WhatIsInvertedOrCrushedIsNotSaidToStayApart) {
    constexpr int kDim = TypeParam::value;
    this->add(test::cube<kDim>(2));
    const auto body = this->make(0.1);
    ASSERT_TRUE(body);
    Positions<kDim> inverted = this->scene_.positions;
    inverted.row(0) *= -1;
    const Positions<kDim> crushed = 0 * this->scene_.positions;
    Positions<kDim> unknown = this->scene_.positions;
    unknown.rightCols(1).setConstant(std::nan(""));
    const PositionsView<kDim> rest(this->scene_.positions);
    EXPECT_TRUE(body->stays_apart({rest, rest}, 0.1));
    for (const Positions<kDim>& x : {inverted, crushed, unknown}) {
        const PositionsView<kDim> view(x);
        EXPECT_FALSE(body->stays_apart({rest, view}, 1e-6));
        EXPECT_FALSE(body->stays_apart({view, rest}, 1e-6));
        EXPECT_FALSE(body->stays_apart({view, view}, 1e-6));
    }
}

TYPED_TEST(ConvexBodyTest, IsNoneOfWhatItCannotTellOf) {
    constexpr int kDim = TypeParam::value;
    this->add(test::cube<kDim>(2));
    EXPECT_TRUE(this->make(0.1));
    EXPECT_FALSE(this->make(0.5));  // cells of 1 m have gaps of 0.58 m
    this->mesh_.cells.resize(kDim + 1, 0);
    EXPECT_FALSE(this->make(0.1));
    this->add(test::carved<kDim>(test::cube<kDim>(2),
                                 [](const Vector<kDim>& x) { return x.minCoeff() > 1; }));
    EXPECT_FALSE(this->make(0.1));
}

}  // namespace
}  // namespace pent::contact
