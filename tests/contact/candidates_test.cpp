#include "candidates.h"

#include "apart.h"
#include "closest_points_oracle.h"
#include "gather.h"
#include "scenes.h"
#include "support/host_tasks.h"

#include <pent/parallel.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <map>
#include <random>
#include <set>
#include <utility>

namespace pent::contact {
namespace {

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

template <typename T>
class CandidatesTest : public testing::Test {
protected:
    static constexpr int kSpace = T::value;
    static constexpr double kDistance = 0.2;
    static constexpr double kInflation = 0.05;

    void SetUp() override {
        scene_.add(test::cube<kSpace>(1), Vector<kSpace>::Zero());
        Vector<kSpace> aside = Vector<kSpace>::Constant(0.13);
        aside[0] = 1.15;
        scene_.add(test::cube<kSpace>(1), aside);
        test::shake<kSpace>(scene_.positions, 0.02, 4);
        options_ = {.model = ContactModel::Barrier, .distance = kDistance};
        model_ = test::contact_scene<kSpace>(scene_, options_);
    }

    // The first body flies at the second and past it, turning; all of them shake.
    [[nodiscard]] Positions<kSpace> target(double way) const {
        Positions<kSpace> to = scene_.positions;
        auto first = to.leftCols(scene_.begin[1]);
        first = test::tilt<kSpace>() * first;
        first.row(0).array() += way;
        test::shake<kSpace>(to, 0.1, 5);
        return to;
    }

    // Pairs nearer than a distance, by looking at all.
    template <int K, int L>
    [[nodiscard]] Pairs near(const Simplices<K>& first,
                             const Simplices<L>& second,
                             const Positions<kSpace>& x,
                             double distance) const {
        Pairs pairs;
        for (std::uint32_t i = 0; i < first.cols(); ++i) {
            for (std::uint32_t j = 0; j < second.cols(); ++j) {
                const auto a = gather<kSpace, K>(first, i, x);
                const auto b = gather<kSpace, L>(second, j, x);
                if (test::closest_points<kSpace, K, L>(a, b).distance_squared
                    < distance * distance) {
                    pairs.insert({i, j});
                }
            }
        }
        return pairs;
    }

    // Whether the cull lets all of them through, on a way that ends at x.
    template <int K, int L>
    void expect_passing(const CandidateList& list,
                        const Simplices<K>& first,
                        const Simplices<L>& second,
                        const Displacement& displacement,
                        const Positions<kSpace>& x,
                        double distance) {
        const DistanceCull cull(list, displacement, distance);
        Pairs passing;
        for (std::size_t k = 0; k < cull.size(); ++k) {
            if (cull.passes(k, first, second)) {
                passing.insert({list.pairs[k].first, list.pairs[k].second});
            }
        }
        const Pairs wanted = near<K, L>(first, second, x, distance);
        EXPECT_TRUE(std::includes(passing.begin(), passing.end(), wanted.begin(), wanted.end()));
        near_ += wanted.size();
        held_back_ += list.pairs.size() - passing.size();
    }

    // Of what goes from one position to another and may be at x then.
    void expect_complete(const Candidates<kSpace>& candidates,
                         const Positions<kSpace>& from,
                         const Positions<kSpace>& to,
                         const Positions<kSpace>& x,
                         double distance) {
        std::set<std::pair<int, int>> met;
        const std::vector<Displacement> displacements = candidates.displacements(from, to);
        ASSERT_EQ(displacements.size(), candidates.meetings().size());
        for (std::size_t m = 0; m < displacements.size(); ++m) {
            const CandidatePairs& pairs = candidates.meetings()[m].pairs;
            expect_complete(pairs, displacements[m], x, distance);
            met.insert({pairs.first, pairs.second});
        }
        const int count = static_cast<int>(scene_.surfaces.size());
        for (int a = 0; a < count; ++a) {
            for (int b = a + 1; b < count; ++b) {
                if (!met.contains({a, b})) {
                    expect_complete({.first = a, .second = b}, {}, x, distance);
                }
            }
        }
    }

    void expect_complete(const CandidatePairs& pairs,
                         const Displacement& displacement,
                         const Positions<kSpace>& x,
                         double distance) {
        const Surface<kSpace>& a = scene_.surfaces[static_cast<std::size_t>(pairs.first)];
        const Surface<kSpace>& b = scene_.surfaces[static_cast<std::size_t>(pairs.second)];
        expect_passing<1, kSpace>(pairs.points_first, a.vertices, b.facets, displacement, x,
                                  distance);
        expect_passing<1, kSpace>(pairs.points_second, b.vertices, a.facets, displacement, x,
                                  distance);
        expect_passing<2, kSpace - 1>(pairs.mixed_first, a.edges, b.ridges, displacement, x,
                                      distance);
        if constexpr (kSpace > 3) {
            expect_passing<2, kSpace - 1>(pairs.mixed_second, b.edges, a.ridges, displacement, x,
                                          distance);
        }
    }

    test::Scene<kSpace> scene_;
    ContactOptions options_;
    ContactScene<kSpace> model_;
    std::size_t near_ = 0;
    std::size_t held_back_ = 0;
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(CandidatesTest, Dimensions);

// Each vertex has a place of its own, however the vertices of two colliders lie.
TEST(DisplacementTest, HasAPlaceForEachVertexOfOneOrTwoColliders) {
    const auto ascending = [](std::initializer_list<std::uint32_t> list) {
        Simplices<1> vertices(1, static_cast<Eigen::Index>(list.size()));
        std::copy(list.begin(), list.end(), vertices.data());
        return vertices;
    };
    const Simplices<1> low = ascending({3, 4, 7});
    for (const Simplices<1>& other :
         {ascending({8, 9}), ascending({1'000'000'000, 1'000'000'002}), ascending({5, 9}),
          ascending({0, 1}), ascending({0, 20}), low}) {
        Displacement displacement(low, other);
        std::map<std::uint32_t, float> expected;
        for (const Simplices<1>& vertices : {low, other}) {
            for (const std::uint32_t v : vertices.reshaped()) {
                expected[v] = static_cast<float>(expected.size() + 1);
                displacement[v] = expected[v];
            }
        }
        for (const auto& [v, value] : expected) {
            EXPECT_EQ(std::as_const(displacement)[v], value);
        }
        EXPECT_EQ(displacement.of<1>(low, 2), expected[7]);
    }
}

TYPED_TEST(CandidatesTest, HoldAllThatComesNearOnTheWay) {
    constexpr int kDim = TypeParam::value;
    for (const double way : {0.05, 0.4, 3.0}) {
        const Colliders<kDim> colliders(this->model_);
        Candidates<kDim> candidates(colliders);
        const Positions<kDim>& from = this->scene_.positions;
        const Positions<kDim> to = this->target(way);
        candidates.cover(from, to);
        for (int k = 0; k <= 10; ++k) {
            const Positions<kDim> x = from + 0.1 * k * (to - from);
            candidates.cover(x);
            EXPECT_EQ(candidates.work().searches, 1);  // the way is covered
            this->expect_complete(candidates, x, x, x, this->kDistance);
            this->expect_complete(candidates, from, to, x, 0.1 * this->kDistance);
        }
    }
    EXPECT_GT(this->near_, 100U);  // the test is about something
}

TYPED_TEST(CandidatesTest, HoldWhileVerticesStayNearTheirPaths) {
    constexpr int kDim = TypeParam::value;
    const Colliders<kDim> colliders(this->model_);
    Candidates<kDim> candidates(colliders);
    const Positions<kDim>& from = this->scene_.positions;
    const Positions<kDim> to = this->target(0.2);
    candidates.cover(from, to);
    for (unsigned seed = 0; seed < 20; ++seed) {
        Positions<kDim> x = from + (seed % 4) / 3.0 * (to - from);
        // Less far than the inflation, even where shaking moves the time that fits best.
        test::shake<kDim>(x, 0.9 * this->kInflation / std::sqrt(kDim), seed);
        candidates.cover(x);
        EXPECT_EQ(candidates.work().searches, 1);
        this->expect_complete(candidates, x, x, x, this->kDistance);
    }
    EXPECT_GT(this->held_back_, 100U);  // the cull is of use
    Positions<kDim> away = from;
    away(1, 0) += 1;
    candidates.cover(away);
    EXPECT_EQ(candidates.work().searches, 2);
    this->expect_complete(candidates, away, away, away, this->kDistance);
}

// Each motion begins where the last search holds, and leads farther.
TYPED_TEST(CandidatesTest, AreSearchedAnewForMotionsThatLeadFromWhatIsCovered) {
    constexpr int kDim = TypeParam::value;
    const Colliders<kDim> colliders(this->model_);
    Candidates<kDim> candidates(colliders);
    const Positions<kDim>& from = this->scene_.positions;
    candidates.cover(from);
    std::int64_t searches = 1;
    for (const double way : {0.2, 0.4, 1.5}) {
        const Positions<kDim> to = this->target(way);
        candidates.cover(from, to);
        EXPECT_EQ(candidates.work().searches, ++searches);
        for (int k = 0; k <= 10; ++k) {
            const Positions<kDim> x = from + 0.1 * k * (to - from);
            this->expect_complete(candidates, x, x, x, this->kDistance);
        }
    }
    EXPECT_GT(this->near_, 100U);
}

// A body of two cubes, so that the box around it has another body in it that is just beyond the
// distance of contact, and comes within it before anything has to be searched anew.
TYPED_TEST(CandidatesTest, HoldWhatComesNearByTheInflationAlone) {
    constexpr int kDim = TypeParam::value;
    const SimplexMesh<kDim> one = test::cube<kDim>(1);
    const Eigen::Index count = one.vertex_count();
    SimplexMesh<kDim> two = one;
    two.positions.conservativeResize(kDim, 2 * count);
    two.positions.rightCols(count) = one.positions;
    two.positions.rightCols(count).row(0).array() += 3;
    two.positions.rightCols(count).row(1).array() += 5;
    two.cells.conservativeResize(kDim + 1, 2 * one.cell_count());
    two.cells.rightCols(one.cell_count()) = one.cells.array() + static_cast<std::uint32_t>(count);
    this->scene_ = {};
    this->scene_.add(two, Vector<kDim>::Zero());
    Vector<kDim> aside = Vector<kDim>::Constant(0.13);
    aside[0] = 1 + this->kDistance + 1.3 * this->kInflation;
    this->scene_.add(one, aside);
    this->model_ = test::contact_scene<kDim>(this->scene_, this->options_);
    const Colliders<kDim> colliders(this->model_);
    Candidates<kDim> candidates(colliders);
    candidates.cover(this->scene_.positions);
    EXPECT_EQ(candidates.work().searches, 1);
    Positions<kDim> x = this->scene_.positions;
    // In the mean nothing moves: a shift of all would not count.
    x.row(0).head(2 * count).array() += 0.475 * this->kInflation;
    x.row(0).tail(count).array() -= 0.95 * this->kInflation;
    candidates.cover(x);
    EXPECT_EQ(candidates.work().searches, 1);
    this->expect_complete(candidates, x, x, x, this->kDistance);
    EXPECT_GT(this->near_, 0U);
}

TYPED_TEST(CandidatesTest, AreSearchedAnewForMotionsThatAreMuchShorterElsewhere) {
    constexpr int kDim = TypeParam::value;
    const Colliders<kDim> colliders(this->model_);
    Candidates<kDim> candidates(colliders);
    const Positions<kDim>& from = this->scene_.positions;
    const Positions<kDim> to = this->target(3);
    candidates.cover(from, to);
    const std::size_t of_flight = candidates.meetings()[0].pairs.points_first.pairs.size();
    const Positions<kDim> near = from + 0.01 * (to - from);
    candidates.cover(from, near);
    EXPECT_EQ(candidates.work().searches, 2);
    ASSERT_EQ(candidates.meetings().size(), 1U);
    EXPECT_LT(candidates.meetings()[0].pairs.points_first.pairs.size(), of_flight);
    candidates.cover(near, from);  // short, and where distances are known
    EXPECT_EQ(candidates.work().searches, 2);
}

// Of three bodies in a row the last comes and goes while the others lie still, or all fly: what is
// searched is what it meets.
TYPED_TEST(CandidatesTest, AreSearchedOfBodiesThatMoveAgainstOneAnotherAlone) {
    constexpr int kDim = TypeParam::value;
    Vector<kDim> aside = Vector<kDim>::Constant(0.1);
    aside[0] = 2.6;
    this->scene_.add(test::cube<kDim>(1), aside);
    this->scene_.body(1).row(0).array() -= 0.05;
    this->scene_.body(2).row(0).array() -= 0.35;
    for (const bool is_penalty : {false, true}) {
        ContactOptions options = this->options_;
        if (is_penalty) {
            options = {.distance = this->kDistance, .margin = this->kInflation};
        }
        const ContactScene<kDim> model = test::contact_scene<kDim>(this->scene_, options);
        const Colliders<kDim> colliders(model);
        Candidates<kDim> candidates(colliders);
        Positions<kDim> x = this->scene_.positions;
        const auto move = [&](int first, int last, double way) {
            const Eigen::Index begin = this->scene_.begin[first];
            x.row(0).segment(begin, this->scene_.begin[last] - begin).array() += way;
            candidates.cover(x);
            this->expect_complete(candidates, x, x, x, this->kDistance);
            return candidates.work().searches;
        };
        EXPECT_EQ(move(0, 3, 0), 2);
        EXPECT_EQ(move(0, 3, 9), 2);
        EXPECT_EQ(move(2, 3, -0.12), 3);
        EXPECT_EQ(move(2, 3, 5), 3);  // out of reach
        EXPECT_EQ(candidates.meetings().size(), 1U);
        EXPECT_EQ(move(2, 3, -5), 4);
        EXPECT_EQ(move(0, 1, 0.12), 5);
        EXPECT_EQ(candidates.meetings().size(), 2U);
    }
}

// Bodies and pairs of them are searched side by side.
TYPED_TEST(CandidatesTest, AreTheSameForAnyNumberOfThreads) {
    constexpr int kDim = TypeParam::value;
    this->scene_.add(test::cube<kDim>(2), Vector<kDim>::Constant(1.05));
    ContactOptions options = this->options_;
    options.self = true;
    const ContactScene<kDim> model = test::contact_scene<kDim>(this->scene_, options);
    const Colliders<kDim> colliders(model);
    std::vector<CandidatePairs> expected;
    for (const int threads : {1, 4}) {
        Candidates<kDim> candidates(colliders);
        Workers(pent::test::host_tasks(threads)).run([&] {
            candidates.cover(this->scene_.positions, this->target(0.1));
        });
        std::vector<CandidatePairs> found;
        for (const Meeting<kDim>& meeting : candidates.meetings()) {
            found.push_back(meeting.pairs);
        }
        if (threads == 1) {
            expected = found;
        }
        ASSERT_EQ(found.size(), 6U);  // of each body, and of each two
        for (std::size_t i = 0; i < found.size(); ++i) {
            for (std::uint32_t place = 0; place < kLists; ++place) {
                const std::vector<Candidate>& here = list_at(found[i], place).list.pairs;
                const std::vector<Candidate>& there = list_at(expected[i], place).list.pairs;
                EXPECT_TRUE(std::equal(here.begin(), here.end(), there.begin(), there.end(),
                                       [](const Candidate& a, const Candidate& b) {
                                           return a.first == b.first && a.second == b.second
                                                  && a.distance == b.distance;
                                       }));
                this->near_ += here.size();
            }
        }
    }
    EXPECT_GT(this->near_, 100U);
}

// A margin of a penalty is a path of no length: what it keeps holds until a vertex has moved that
// far.
TYPED_TEST(CandidatesTest, OfAMarginHoldWhileNoVertexMovesFarther) {
    constexpr int kDim = TypeParam::value;
    this->scene_.body(1).row(0).array() -= 0.1;  // near one another
    const ContactOptions options{.distance = this->kDistance, .margin = 0.1};
    const ContactScene<kDim> model = test::contact_scene<kDim>(this->scene_, options);
    const Colliders<kDim> colliders(model);
    Candidates<kDim> candidates(colliders);
    for (unsigned seed = 0; seed < 10; ++seed) {
        Positions<kDim> x = this->scene_.positions;
        if (seed > 0) {
            test::shake<kDim>(x, 0.09 / std::sqrt(kDim), seed);
        }
        candidates.cover(x);
        candidates.drop_what_is_not_kept();
        EXPECT_EQ(candidates.work().searches, 1);
        this->expect_complete(candidates, x, x, x, this->kDistance);
    }
    EXPECT_GT(this->near_, 100U);
    Positions<kDim> away = this->scene_.positions;
    away(1, 0) += 0.2;
    candidates.cover(away);
    EXPECT_EQ(candidates.work().searches, 2);
}

TYPED_TEST(CandidatesTest, WithoutAMarginAreExactAndNotKept) {
    constexpr int kDim = TypeParam::value;
    this->scene_.body(1).row(0).array() -= 0.1;
    const ContactScene<kDim> model =
        test::contact_scene<kDim>(this->scene_, {.distance = this->kDistance});
    const Colliders<kDim> colliders(model);
    Candidates<kDim> candidates(colliders);
    const Positions<kDim>& x = this->scene_.positions;
    candidates.cover(x);
    EXPECT_TRUE(candidates.is_exact());
    ASSERT_EQ(candidates.meetings().size(), 1U);
    const Surface<kDim>& a = this->scene_.surfaces[0];
    const Surface<kDim>& b = this->scene_.surfaces[1];
    EXPECT_EQ(candidates.meetings()[0].pairs.points_first.pairs.size(),
              (this->template near<1, kDim>(a.vertices, b.facets, x, this->kDistance).size()));
    int inside = 0;
    for (std::uint32_t i = 0; i < a.edges.cols(); ++i) {
        for (std::uint32_t j = 0; j < b.ridges.cols(); ++j) {
            const auto edge = gather<kDim, 2>(a.edges, i, x);
            const auto ridge = gather<kDim, kDim - 1>(b.ridges, j, x);
            inside += ClosestPointSearch<kDim, 2, kDim - 1>(edge, ridge,
                                                            this->kDistance * this->kDistance)
                              .run_interior()
                          ? 1
                          : 0;
        }
    }
    EXPECT_EQ(candidates.meetings()[0].pairs.mixed_first.pairs.size(),
              static_cast<std::size_t>(inside));
    candidates.drop_what_is_not_kept();
    EXPECT_EQ(candidates.meetings().size(), 0U);
    candidates.cover(x);
    EXPECT_EQ(candidates.work().searches, 2);
}

TYPED_TEST(CandidatesTest, PathsAreApartOnlyIfPointsAreAtAllTimes) {
    constexpr int kDim = TypeParam::value;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    const auto corners = [&]<int Count>(double at) {
        Corners<kDim, Count> points =
            Corners<kDim, Count>::NullaryExpr([&] { return 0.5 * coordinate(random); });
        points.row(0).array() += at;
        return points;
    };
    int apart = 0;
    for (int k = 0; k < 2000; ++k) {
        const double drift = 10 * coordinate(random);  // of both: it does not matter
        const auto a = corners.template operator()<2>(0);
        const auto b = corners.template operator()<3>(1.5 + coordinate(random));
        const auto a_end = corners.template operator()<2>(drift);
        const auto b_end = corners.template operator()<3>(drift + 1.5 + coordinate(random));
        const double distance = 0.4;
        if (!are_paths_apart<kDim, 2, 3>(a, a_end, b, b_end, distance * distance)) {
            continue;
        }
        ++apart;
        for (int s = 0; s <= 20; ++s) {
            const double t = 0.05 * s;
            const Corners<kDim, 2> p = (1 - t) * a + t * a_end;
            const Corners<kDim, 3> q = (1 - t) * b + t * b_end;
            // A linear bound by any direction holds for the hulls; boxes give the best of the axes.
            const Vector<kDim> gap = (q.rowwise().minCoeff() - p.rowwise().maxCoeff())
                                         .cwiseMax(p.rowwise().minCoeff() - q.rowwise().maxCoeff())
                                         .cwiseMax(0);
            EXPECT_GE(gap.norm(), distance * (1 - 1e-12));
        }
    }
    EXPECT_GT(apart, 200);
    EXPECT_LT(apart, 1800);
}

}  // namespace
}  // namespace pent::contact
