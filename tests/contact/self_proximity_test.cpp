#include "self_proximity.h"

#include "bodies.h"
#include "closest_points_oracle.h"
#include "gather.h"
#include "overlaps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace pent::contact {
namespace {

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

constexpr double kDistance = 0.25;  // cells are 1 m

template <typename T>
class SelfProximityTest : public testing::Test {
protected:
    static constexpr int kD = T::value;

    static constexpr int kLength = kD == 3 ? 16 : 8;

    void SetUp() override {
        scene_.add(test::bar<kD>(kLength), Vector<kD>::Zero());
        test::shake<kD>(scene_.positions, 0.05, 3);
    }

    // The bar bent, shaken, turned and moved.
    [[nodiscard]] Positions<kD> bent(double amount, double shake, unsigned seed) const {
        Positions<kD> x = scene_.positions;
        test::bend<kD>(x, kLength, amount);
        test::shake<kD>(x, shake, seed);
        return ((1 + amount) * test::tilt<kD>() * x).colwise() + 10 * amount * Vector<kD>::Ones();
    }

    // All pairs nearer than contact now and not at rest.
    template <int K, int L>
    [[nodiscard]] Pairs near(const Simplices<K>& first,
                             const Simplices<L>& second,
                             const Positions<kD>& x) const {
        Pairs pairs;
        for (std::uint32_t i = 0; i < first.cols(); ++i) {
            for (std::uint32_t j = K == L ? i + 1 : 0; j < second.cols(); ++j) {
                if (share_a_vertex<K, L>(first, i, second, j)) {
                    continue;
                }
                const auto closest = [&](const Positions<kD>& at) {
                    return test::closest_points<kD, K, L>(gather<kD, K>(first, i, at),
                                                          gather<kD, L>(second, j, at));
                };
                const auto now = closest(x);
                const bool is_inside =
                    K == 1 || std::min(now.beta.minCoeff(), now.alpha.minCoeff()) > 1e-9;
                if (is_inside && now.distance_squared < kDistance * kDistance
                    && closest(scene_.positions).distance_squared > kDistance * kDistance) {
                    pairs.insert({i, j});
                }
            }
        }
        return pairs;
    }

    template <int K, int L>
    void expect_all(const CandidateList& list,
                    const Simplices<K>& first,
                    const Simplices<L>& second,
                    const Positions<kD>& x) {
        EXPECT_TRUE(std::is_sorted(list.pairs.begin(), list.pairs.end(), is_before));
        Pairs found;
        for (const Candidate& pair : list.pairs) {
            found.insert({pair.first, pair.second});
            EXPECT_LT((test::closest_points<kD, K, L>(gather<kD, K>(first, pair.first, x),
                                                      gather<kD, L>(second, pair.second, x))
                           .distance_squared),
                      kDistance * kDistance * (1 + 1e-9));
        }
        EXPECT_EQ(found.size(), list.pairs.size());  // each once
        const Pairs wanted = near<K, L>(first, second, x);
        EXPECT_TRUE(std::includes(found.begin(), found.end(), wanted.begin(), wanted.end()));
        near_ += wanted.size();
    }

    test::Scene<kD> scene_;
    std::size_t near_ = 0;
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(SelfProximityTest, Dimensions);

// Brute force, on the way from rest into a ring and back, through slow and through wild motion: in
// steps over which bounds hold, over which they fail here and there, and over which they all do.
TYPED_TEST(SelfProximityTest, FindsAllThatIsNearWhateverHappenedBefore) {
    constexpr int kDim = TypeParam::value;
    const Surface<kDim>& surface = this->scene_.surfaces[0];
    SelfProximity<kDim> kept(surface, this->scene_.positions, kDistance, true);
    const double amounts[] = {0,    0.01, 0.02, 0.03, 0.05, 0.1, 0.2,  0.4, 0.6,  0.8,
                              0.95, 1,    1.01, 1.02, 1.03, 1.1, 1.03, 0.9, 1.03, 0};
    unsigned seed = 0;
    for (const double amount : amounts) {
        ++seed;
        const Positions<kDim> x = this->bent(amount, seed % 5 == 0 ? 0.2 : 0.01, seed);
        const CandidatePairs pairs = kept.find(x);
        this->template expect_all<1, kDim>(pairs.points_first, surface.vertices, surface.facets, x);
        this->template expect_all<2, kDim - 1>(pairs.mixed_first, surface.edges, surface.ridges, x);
        // The same as of one that was asked nothing before, but for pairs that are near at rest.
        SelfProximity<kDim> fresh(surface, this->scene_.positions, kDistance, true);
        const CandidatePairs anew = fresh.find(x);
        this->template expect_all<1, kDim>(anew.points_first, surface.vertices, surface.facets, x);
    }
    EXPECT_GT(this->near_, 100U);
}

// Of paths between these places, at times on the way: all that come within the distance while
// vertices are off their paths, those near at rest too, with distances that are no more than at the
// end.
TYPED_TEST(SelfProximityTest, FindsAllThatComesNearOnPathsWhateverHappenedBefore) {
    constexpr int kDim = TypeParam::value;
    constexpr double kInflation = 0.02;
    constexpr double kActivationDistance = 0.1;
    constexpr double kMeasured = 0.16;
    const Surface<kDim>& surface = this->scene_.surfaces[0];
    SelfProximity<kDim> kept(surface, this->scene_.positions, kActivationDistance + 2 * kInflation,
                             false);
    const std::pair<double, double> steps[] = {{0, 0.005},     {0.01, 0.02}, {0.02, 0.1},
                                               {0.5, 0.51},    {0.95, 1},    {1, 1.001},
                                               {1.001, 1.002}, {1, 0.6},     {0, 0}};
    std::size_t near = 0;
    unsigned seed = 0;
    for (const auto& [from, to] : steps) {
        ++seed;
        const Positions<kDim> start = this->bent(from, seed % 3 == 0 ? 0.1 : 0, seed);
        const Positions<kDim> end = this->bent(to, 0.005, seed + 1);
        const PositionsView<kDim> first_place = start;
        const PositionsView<kDim> last_place = end;
        Paths<kDim> paths{first_place, last_place, mean_shift<kDim>(surface.vertices, start, end)};
        Eigen::VectorXd inflation = Eigen::VectorXd::Zero(start.cols());
        set_inflation<kDim>(surface.vertices, paths, kInflation, 0.1, inflation);
        paths.inflation = &inflation;
        const CandidatePairs pairs = kept.find(paths, kActivationDistance, kMeasured);
        const auto expect_all = [&]<int K, int L>(const CandidateList& list,
                                                  const Simplices<K>& first,
                                                  const Simplices<L>& second) {
            std::map<std::pair<std::uint32_t, std::uint32_t>, float> found;
            for (const Candidate& pair : list.pairs) {
                EXPECT_TRUE(found.insert({{pair.first, pair.second}, pair.distance}).second);
            }
            for (std::uint32_t i = 0; i < first.cols(); ++i) {
                for (std::uint32_t j = K == L ? i + 1 : 0; j < second.cols(); ++j) {
                    if (share_a_vertex<K, L>(first, i, second, j)) {
                        continue;
                    }
                    // Whatever point is nearest may come nearer by this.
                    const double near_enough = kActivationDistance
                                               + inflation(first.col(i)).minCoeff()
                                               + inflation(second.col(j)).minCoeff();
                    double at_end = 0;
                    double least = near_enough;
                    for (const double t : {0.0, 0.5, 1.0}) {
                        const Positions<kDim> x = start + t * (end - start);
                        at_end = std::sqrt(
                            test::closest_points<kDim, K, L>(gather<kDim, K>(first, i, x),
                                                             gather<kDim, L>(second, j, x))
                                .distance_squared);
                        least = std::min(least, at_end);
                    }
                    const auto place = found.find({i, j});
                    if (place != found.end()) {
                        EXPECT_LE(static_cast<double>(place->second), at_end * (1 + 1e-6));
                    }
                    if (least < near_enough) {
                        ++near;
                        EXPECT_TRUE(place != found.end()) << i << " " << j << " step " << seed;
                    }
                }
            }
        };
        expect_all.template operator()<1, kDim>(pairs.points_first, surface.vertices,
                                                surface.facets);
        expect_all.template operator()<2, kDim - 1>(pairs.mixed_first, surface.edges,
                                                    surface.ridges);
    }
    EXPECT_GT(near, 100U);
}

// Bent as before, elsewhere, turned and a little farther.
TYPED_TEST(SelfProximityTest, LooksAtFewPairsWhereABodyHardlyChanges) {
    constexpr int kDim = TypeParam::value;
    const Surface<kDim>& surface = this->scene_.surfaces[0];
    SelfProximity<kDim> proximity(surface, this->scene_.positions, kDistance, true);
    const std::int64_t at_first = proximity.find(this->bent(0.85, 0, 1)).overlaps();
    EXPECT_GT(at_first, 0);
    const Positions<kDim> later =
        (test::tilt<kDim>() * this->bent(0.855, 0, 1)).colwise() + 7 * Vector<kDim>::Ones();
    EXPECT_LT(proximity.find(later).overlaps(), at_first / 2);
}

// What is listed where nothing changes stays listed, however often the end wants other lists: an
// end that shakes costs a part of what the whole does.
TYPED_TEST(SelfProximityTest, AnEndThatShakesCostsNothingElsewhere) {
    constexpr int kDim = TypeParam::value;
    const Surface<kDim>& surface = this->scene_.surfaces[0];
    SelfProximity<kDim> of_end(surface, this->scene_.positions, 0.1, true);
    SelfProximity<kDim> of_all(surface, this->scene_.positions, 0.1, true);
    const Positions<kDim> still = this->bent(0, 0, 1);
    std::int64_t end = 0;
    std::int64_t all = 0;
    for (unsigned seed = 1; seed <= 40; ++seed) {
        const Positions<kDim> shaken = this->bent(0, 0.2, seed);
        Positions<kDim> x = still;
        for (Eigen::Index v = 0; v < x.cols(); ++v) {
            if (this->scene_.positions(0, v) < 1.5) {
                x.col(v) = shaken.col(v);
            }
        }
        end += of_end.find(x).overlaps();
        all += of_all.find(shaken).overlaps();
    }
    EXPECT_LT(end, all / 2);
}

}  // namespace
}  // namespace pent::contact
