#include "patch_vertices.h"

#include "boxes_around.h"
#include "scenes.h"

#include <gtest/gtest.h>

#include <set>

namespace pent::contact {
namespace {

template <int Dim, int Count>
void expect_vertices_of(const Simplices<Count>& simplices, const Positions<Dim>& positions) {
    const PatchPartition partition(
        boxes_around<Dim, Count>(simplices, PositionsView<Dim>(positions), 0));
    const PatchVertices vertices(simplices, partition);
    ASSERT_EQ(vertices.size(), partition.size());
    EXPECT_EQ(vertices.corner_count(), Count);
    EXPECT_GT(vertices.bytes(), 0);
    std::size_t sum = 0;
    for (std::size_t patch = 0; patch < partition.size(); ++patch) {
        const auto members = partition[patch];
        ASSERT_EQ(vertices.simplex_count(patch), static_cast<int>(members.size()));
        std::set<std::uint32_t> expected;
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const std::uint32_t simplex = members[lane < members.size() ? lane : 0];
            for (std::size_t corner = 0; corner < Count; ++corner) {
                const std::uint32_t vertex = simplices(static_cast<Eigen::Index>(corner), simplex);
                expected.insert(vertex);
                EXPECT_EQ(vertices.corners(patch)[corner * kLanes + lane],
                          static_cast<std::int32_t>(vertex));
                EXPECT_EQ(vertices[patch][vertices.places(patch)[corner * kLanes + lane]], vertex);
            }
        }
        const std::vector<std::uint32_t> own(vertices[patch].begin(), vertices[patch].end());
        EXPECT_EQ(own, std::vector<std::uint32_t>(expected.begin(), expected.end()));
        EXPECT_EQ(vertices.starts()[patch], sum);
        sum += own.size();
    }
    EXPECT_EQ(vertices.of_all().size(), sum);
}

template <typename T>
class PatchVerticesTest : public testing::Test {};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(PatchVerticesTest, Dimensions);

TYPED_TEST(PatchVerticesTest, AreTheCornersOfTheirSimplices) {
    constexpr int kDim = TypeParam::value;
    test::Scene<kDim> scene;
    scene.add(test::cube<kDim>(2), Vector<kDim>::Zero());
    const Surface<kDim>& surface = scene.surfaces[0];
    expect_vertices_of<kDim>(surface.vertices, scene.positions);
    expect_vertices_of<kDim>(surface.edges, scene.positions);
    expect_vertices_of<kDim>(surface.ridges, scene.positions);
    expect_vertices_of<kDim>(surface.facets, scene.positions);
}

TEST(PatchVertices, OfNothingThereAreNone) {
    EXPECT_EQ(PatchVertices().size(), 0U);
    EXPECT_EQ(PatchVertices(Simplices<2>(2, 0), PatchPartition()).size(), 0U);
}

}  // namespace
}  // namespace pent::contact
