#include "pairs_within.h"

#include "boxes_around.h"
#include "near_pairs.h"
#include "scenes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace pent::contact {
namespace {

template <typename T>
class PairsWithinTest : public testing::Test {};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(PairsWithinTest, Dimensions);

// All near pairs that were far enough apart at rest are among them, and all of them are near pairs.
TYPED_TEST(PairsWithinTest, LeaveOutNoPairThatWasApartAtRest) {
    constexpr int kDim = TypeParam::value;
    std::array<int, kDim> count{};
    std::array<double, kDim> size{};
    count.fill(1);
    size.fill(1);
    count[0] = kDim == 3 ? 24 : 10;
    size[0] = count[0];
    test::Scene<kDim> scene;
    scene.add(pent::test::kuhn_box<kDim>(count, size), Vector<kDim>::Zero());
    const Positions<kDim> rest = scene.positions;
    const Surface<kDim>& surface = scene.surfaces[0];
    constexpr double kDistance = 0.3;
    constexpr double kRestDistance = 0.6;
    std::int64_t left_out = 0;  // pairs of boxes
    std::size_t apart_at_rest = 0;
    for (const double radius : {20.0, size[0] / 6.4}) {  // bent a little, and into a ring
        Positions<kDim> x = rest;
        for (auto column : x.colwise()) {
            const double angle = column[0] / radius;
            const double r = radius + 0.06 * angle - column[kDim - 1];
            column[kDim - 1] = r * std::sin(angle);
            column[0] = r * std::cos(angle);
        }
        std::vector<Box> boxes = boxes_around<kDim, 1>(surface.vertices, x, kDistance / 2);
        SurfaceTrees<kDim> trees;
        trees.update_vertices(surface, boxes);
        trees.update_faces(surface, boxes);
        trees.update_patches(surface, rest, x);
        const CandidateList found = pairs_within<kDim, 1, kDim>(
            trees.template patched<1>(surface), trees.template patched<kDim>(surface), x, kDistance,
            kRestDistance, Closest::Anywhere);
        const CandidateList all =
            near_pairs<kDim, 1, kDim>({surface.vertices, trees.template tree<1>()},
                                      {surface.facets, trees.template tree<kDim>()}, x, kDistance);
        EXPECT_TRUE(std::ranges::includes(all.pairs, found.pairs, is_before));
        for (const Candidate& pair : all.pairs) {
            const Corners<kDim, 1> point = gather<kDim, 1>(surface.vertices, pair.first, rest);
            const Corners<kDim, kDim> facet = gather<kDim, kDim>(surface.facets, pair.second, rest);
            ClosestPointSearch<kDim, 1, kDim> search(point, facet, kRestDistance * kRestDistance);
            if (!search.run()) {
                ++apart_at_rest;
                EXPECT_TRUE(std::ranges::binary_search(found.pairs, pair, is_before));
            }
        }
        left_out += all.overlaps - found.overlaps;
    }
    EXPECT_GT(apart_at_rest, 0U);
    EXPECT_GT(left_out, 100);
}

}  // namespace
}  // namespace pent::contact
