#include "step_limit.h"

#include "ccd.h"
#include "obstacle_contacts.h"
#include "support/host_tasks.h"
#include "two_cubes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace pent::contact {
namespace {

template <typename T>
class StepLimitTest : public testing::Test {
protected:
    static constexpr int kSpace = T::value;

    // The least safe fraction of all pairs of two lists, one by one.
    template <int K, int L>
    void shorten(const Simplices<K>& a,
                 const Simplices<L>& b,
                 const Positions<kSpace>& motion,
                 double& least) const {
        const Positions<kSpace>& x = cubes_.scene.positions;
        for (Eigen::Index i = 0; i < a.cols(); ++i) {
            for (Eigen::Index j = 0; j < b.cols(); ++j) {
                least =
                    std::min(least, safe_fraction<kSpace, K, L>(
                                        gather<kSpace, K>(a, i, x), gather<kSpace, K>(a, i, motion),
                                        gather<kSpace, L>(b, j, x), gather<kSpace, L>(b, j, motion),
                                        {cubes_.options.separation, cubes_.options.distance}));
            }
        }
    }

    test::TwoCubes<kSpace> cubes_;
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(StepLimitTest, Dimensions);

// Nothing crosses, and a tenth of the gap is left all the same.
TYPED_TEST(StepLimitTest, KeepsATenthOfTheGapFromMotionsThatEndBeforeTheyTouch) {
    constexpr int kDim = TypeParam::value;
    // 0.1 between flat sides, of which 0.01 is the separation.
    ContactFinder<kDim> finder(this->cubes_.model());
    const Positions<kDim>& x = this->cubes_.rest;
    for (const double end : {0.008, 0.004, 0.0001}) {
        Positions<kDim> to = x;
        to.leftCols(this->cubes_.scene.begin[1]).row(0).array() += 0.09 - end;
        const double fraction = finder.limit_step(x, to).fraction;
        const double left = 0.09 - fraction * (0.09 - end);
        EXPECT_LT(fraction, 1) << end;
        EXPECT_GE(left, 0.009 - 1e-12) << end;
        EXPECT_LT(left, 0.02) << end;
    }
}

TYPED_TEST(StepLimitTest, IsTheLeastOfAllPairsForAnyNumberOfThreads) {
    constexpr int kDim = TypeParam::value;
    ContactFinder<kDim> finder(this->cubes_.model());
    const Positions<kDim>& x = this->cubes_.scene.positions;
    for (const double speed : {0.05, 0.3, 20.0}) {
        Positions<kDim> to = this->cubes_.pushed(speed);
        test::shake<kDim>(to, 0.01, 9);
        const Positions<kDim> motion = to - x;
        double least = 1;
        const Surface<kDim>& first = this->cubes_.scene.surfaces[0];
        const Surface<kDim>& second = this->cubes_.scene.surfaces[1];
        this->template shorten<1, kDim>(first.vertices, second.facets, motion, least);
        this->template shorten<1, kDim>(second.vertices, first.facets, motion, least);
        this->template shorten<2, kDim - 1>(first.edges, second.ridges, motion, least);
        this->template shorten<2, kDim - 1>(second.edges, first.ridges, motion, least);
        const StepLimit limit = finder.limit_step(x, to);
        EXPECT_DOUBLE_EQ(limit.fraction, least);
        if (least < 1) {
            EXPECT_EQ(limit.limiting.first_corners.size() + limit.limiting.second_corners.size(),
                      kDim + 1U);
        }
        Workers(pent::test::host_tasks(3)).run([&] {
            ContactFinder<kDim> fresh(this->cubes_.model());
            const StepLimit again = fresh.limit_step(x, to);
            EXPECT_EQ(again.fraction, limit.fraction);
            EXPECT_EQ(again.limiting.first_corners, limit.limiting.first_corners);
        });
    }
}

// Many pairs of many bodies allow the same fraction to the bit, since all are where numbers are
// exact: whichever a thread finds first, the first of them is named.
TYPED_TEST(StepLimitTest, NamesTheFirstOfEqualPairsForAnyNumberOfThreads) {
    constexpr int kDim = TypeParam::value;
    constexpr int kTwos = 6;
    test::Scene<kDim> scene;
    for (int i = 0; i < kTwos; ++i) {
        Vector<kDim> at = Vector<kDim>::Constant(4 * i);
        scene.add(test::cube<kDim>(1), at);
        at.array() += 0.125;
        at[0] += 1;
        scene.add(test::cube<kDim>(1), at);
    }
    Positions<kDim> to = scene.positions;
    for (int i = 0; i < kTwos; ++i) {
        to.middleCols(scene.begin[2 * i + 1], scene.begin[2 * i + 2] - scene.begin[2 * i + 1])
            .row(0)
            .array() -= 0.25;
    }
    const ContactScene<kDim> model = test::contact_scene<kDim>(
        scene, {.model = ContactModel::Barrier, .distance = 0.25, .separation = 0});
    const StepLimit first = ContactFinder<kDim>(model).limit_step(scene.positions, to);
    EXPECT_LT(first.fraction, 0.5);
    EXPECT_EQ(std::max(first.limiting.first.index, first.limiting.second.index), 1U);
    for (const int threads : {1, 2, 3, 8, 8, 8, 8}) {
        Workers(pent::test::host_tasks(threads)).run([&] {
            const StepLimit again = ContactFinder<kDim>(model).limit_step(scene.positions, to);
            EXPECT_EQ(again.fraction, first.fraction);
            EXPECT_EQ(again.limiting.first, first.limiting.first);
            EXPECT_EQ(again.limiting.second, first.limiting.second);
            EXPECT_EQ(again.limiting.first_corners, first.limiting.first_corners);
            EXPECT_EQ(again.limiting.second_corners, first.limiting.second_corners);
        });
    }
}

TYPED_TEST(StepLimitTest, IsTheWholeStepUnderAPenalty) {
    constexpr int kDim = TypeParam::value;
    this->cubes_.options.model = ContactModel::Penalty;
    ContactFinder<kDim> finder(this->cubes_.model());
    EXPECT_EQ(finder.limit_step(this->cubes_.scene.positions, this->cubes_.pushed(20)).fraction, 1);
}

// Below the middle of the lowest side of the first cube: facets meet them between their vertices.
TYPED_TEST(StepLimitTest, LetsNoFacetCutABallOrABoxBetweenItsVertices) {
    constexpr int kDim = TypeParam::value;
    for (const ObstacleShape<kDim>& obstacle :
         {ObstacleShape<kDim>(Ball<kDim>{this->cubes_.below(0.35), 0.2}),
          ObstacleShape<kDim>(
              Cuboid<kDim>{this->cubes_.below(0.3), Vector<kDim>::Constant(0.3)})}) {
        ContactFinder<kDim> finder(this->cubes_.model({obstacle}));
        const Positions<kDim>& x = this->cubes_.scene.positions;
        Positions<kDim> to = x;
        to.row(kDim - 1).array() -= 0.3;
        const StepLimit limit = finder.limit_step(x, to);
        EXPECT_LT(limit.fraction, 0.5);
        EXPECT_GT(limit.fraction, 0.2);
        EXPECT_EQ(limit.limiting.second, (Collider{Collider::Kind::Obstacle, 0}));
        EXPECT_FALSE(limit.limiting.first_corners.empty());
        const Positions<kDim> near = x + 0.9 * limit.fraction * (to - x);
        Positions<kDim> gradient = Positions<kDim>::Zero(kDim, x.cols());
        add_gradient<kDim>(finder.find(near, 1), gradient);
        EXPECT_LT(gradient.row(kDim - 1).sum(), 0);  // pushed up
    }
}

TYPED_TEST(StepLimitTest, KeepsVerticesOutOfHalfSpaces) {
    constexpr int kDim = TypeParam::value;
    const HalfSpace<kDim> floor{Vector<kDim>::Unit(1), -0.1};
    ContactFinder<kDim> finder(this->cubes_.model({floor, floor}));  // the first of equals is named
    const Positions<kDim>& x = this->cubes_.scene.positions;
    Positions<kDim> to = x;
    to.row(1).array() -= 1;
    const StepLimit limit = finder.limit_step(x, to);
    EXPECT_LT(limit.fraction, 0.15);
    EXPECT_EQ(limit.limiting.first_corners.size(), 1U);
    EXPECT_EQ(limit.limiting.second, (Collider{Collider::Kind::Obstacle, 0}));
    const Positions<kDim> at = x + limit.fraction * (to - x);
    EXPECT_GT(at.row(1).minCoeff(), -0.1 + this->cubes_.options.separation);
}

// The first cube goes to the other and down to a half-space, which it meets first, or not.
TYPED_TEST(StepLimitTest, IsTheLesserOfWhatPairsAndWhatSurfacesOfObstaclesAllow) {
    constexpr int kDim = TypeParam::value;
    const Positions<kDim>& x = this->cubes_.scene.positions;
    Positions<kDim> to = this->cubes_.pushed(0.5);
    to.row(1).array() -= 1;
    const double of_pairs = ContactFinder<kDim>(this->cubes_.model()).limit_step(x, to).fraction;
    int obstacles_first = 0;
    int pairs_first = 0;
    for (const double height : {-0.05, -0.1, -0.2, -0.4, -2.0}) {
        ContactScene<kDim> scene =
            this->cubes_.model({HalfSpace<kDim>{Vector<kDim>::Unit(1), height}});
        ContactFinder<kDim> both(scene);
        const StepLimit limit = both.limit_step(x, to);
        scene.ignored.emplace_back(0, 1);
        const double of_obstacle = ContactFinder<kDim>(scene).limit_step(x, to).fraction;
        EXPECT_EQ(limit.fraction, std::min(of_pairs, of_obstacle)) << height;
        EXPECT_EQ(limit.limiting.second.kind == Collider::Kind::Obstacle, of_obstacle <= of_pairs);
        ++(of_obstacle < of_pairs ? obstacles_first : pairs_first);
        // Whatever has been searched before.
        EXPECT_EQ(both.limit_step(x, to).fraction, limit.fraction);
    }
    EXPECT_GE(obstacles_first, 2);  // the test is about something
    EXPECT_GE(pairs_first, 1);
}

TYPED_TEST(StepLimitTest, SearchesNoFartherThanSurfacesOfObstaclesLetGo) {
    constexpr int kDim = TypeParam::value;
    this->cubes_.options.distance = 0.02;
    const auto count_of = [&](const std::vector<ObstacleShape<kDim>>& obstacles) {
        const ContactScene<kDim> scene = this->cubes_.model(obstacles);
        const Colliders<kDim> colliders(scene);
        Candidates<kDim> candidates(colliders);
        const PositionsView<kDim> from = this->cubes_.scene.positions;
        Positions<kDim> to = this->cubes_.pushed(0.07);
        to.row(1).array() -= 1;
        static_cast<void>(find_step_limit<kDim>(candidates, vertices_at_obstacles(colliders), from,
                                                PositionsView<kDim>(to)));
        std::size_t count = 0;
        for (const Meeting<kDim>& meeting : candidates.meetings()) {
            count += meeting.pairs.size();
        }
        return count;
    };
    EXPECT_GT(count_of({}), 0U);
    EXPECT_EQ(count_of({HalfSpace<kDim>{Vector<kDim>::Unit(1), -0.1}}), 0U);
}

}  // namespace
}  // namespace pent::contact
