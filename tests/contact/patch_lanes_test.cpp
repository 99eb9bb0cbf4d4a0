#include "patch_lanes.h"

#include "boxes_around.h"
#include "scenes.h"

#include <gtest/gtest.h>

namespace pent::contact {
namespace {

template <typename T>
class PatchLanesTest : public testing::Test {};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(PatchLanesTest, Dimensions);

// Far from the coordinates' origin, too, where floats of these would be of no use.
TYPED_TEST(PatchLanesTest, CornersAreThoseOfTheirSimplices) {
    constexpr int kDim = TypeParam::value;
    test::Scene<kDim> scene;
    scene.add(test::cube<kDim>(2), Vector<kDim>::Zero());
    const Surface<kDim>& surface = scene.surfaces[0];
    const PositionsView<kDim> rest = scene.positions;
    const PatchPartition partition(boxes_around<kDim, kDim>(surface.facets, rest, 0));
    const PatchVertices vertices(surface.facets, partition);
    PatchLanes<kDim> lanes;
    for (const double away : {0.0, 1e7}) {
        const Positions<kDim> positions = (scene.positions.array() + away).matrix();
        lanes.set(vertices, positions);
        for (std::size_t patch = 0; patch < partition.size(); ++patch) {
            const LanesView view = lanes.of(patch, vertices);
            ASSERT_EQ(view.count, static_cast<int>(partition[patch].size()));
            float most = 0;
            const Eigen::Map<const Eigen::Matrix<float, kDim, 1>> low(view.low);
            const Eigen::Map<const Eigen::Matrix<float, kDim, 1>> high(view.high);
            Eigen::Matrix<float, kDim, 1> least = high;
            Eigen::Matrix<float, kDim, 1> greatest = low;
            for (int lane = 0; lane < kLanes; ++lane) {
                const std::uint32_t facet =
                    partition[patch][lane < view.count ? static_cast<std::size_t>(lane) : 0];
                for (int corner = 0; corner < kDim; ++corner) {
                    EXPECT_EQ(view.vertices[corner * kLanes + lane],
                              static_cast<std::int32_t>(surface.facets(corner, facet)));
                    for (int axis = 0; axis < kDim; ++axis) {
                        const float x = view.corners[(corner * kDim + axis) * kLanes + lane];
                        EXPECT_NEAR(static_cast<double>(x) + view.origin[axis],
                                    positions(axis, surface.facets(corner, facet)),
                                    1e-7 + 1e-15 * away);
                        most = std::max(most, std::abs(x));
                        least[axis] = std::min(least[axis], x);
                        greatest[axis] = std::max(greatest[axis], x);
                    }
                }
            }
            EXPECT_EQ(view.extent, most);
            EXPECT_EQ(least, low);
            EXPECT_EQ(greatest, high);
        }
    }
    EXPECT_GT(lanes.bytes(), 0);
}

}  // namespace
}  // namespace pent::contact
