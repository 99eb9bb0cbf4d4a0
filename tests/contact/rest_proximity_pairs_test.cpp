#include "rest_proximity_pairs.h"

#include "closest_points_oracle.h"
#include "gather.h"
#include "overlaps.h"
#include "scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>

namespace pent::contact {
namespace {

constexpr double kEps = 0.2;  // cells are 1 m

template <typename T>
class RestProximityPairsTest : public testing::Test {};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(RestProximityPairsTest, Dimensions);

TYPED_TEST(RestProximityPairsTest, AreThoseBetweenTheDistanceOfContactAndTwiceThat) {
    constexpr int kDim = TypeParam::value;
    test::Scene<kDim> scene;
    scene.add(test::cube<kDim>(kDim == 3 ? 4 : 2), Vector<kDim>::Zero());
    scene.positions.row(kDim - 1) *= 0.3;
    test::shake<kDim>(scene.positions, 0.04, 5);
    const Surface<kDim>& surface = scene.surfaces[0];
    const RestProximityPairs near = find_rest_proximity_pairs<kDim>(surface, scene.positions, kEps);
    EXPECT_EQ(near.rest_distance, 2 * kEps);
    std::set<std::pair<std::uint32_t, std::uint32_t>> found;
    for (const Candidate& pair : near.mixed.pairs) {
        found.insert({pair.first, pair.second});
    }
    EXPECT_GT(found.size(), 0U);
    for (std::uint32_t i = 0; i < surface.edges.cols(); ++i) {
        for (std::uint32_t j = kDim == 3 ? i + 1 : 0; j < surface.ridges.cols(); ++j) {
            if (share_a_vertex<2, kDim - 1>(surface.edges, i, surface.ridges, j)) {
                continue;
            }
            const double l =
                std::sqrt(test::closest_points<kDim, 2, kDim - 1>(
                              gather<kDim, 2>(surface.edges, i, scene.positions),
                              gather<kDim, kDim - 1>(surface.ridges, j, scene.positions))
                              .distance_squared);
            EXPECT_EQ(found.count({i, j}), l >= kEps && l < 2 * kEps ? 1U : 0U) << l;
        }
    }
    // With a distance of contact near the length of edges they would be too many to be of use.
    EXPECT_EQ(find_rest_proximity_pairs<kDim>(surface, scene.positions, 1).rest_distance, 0);
}

}  // namespace
}  // namespace pent::contact
