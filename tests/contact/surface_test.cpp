#include "scenes.h"

#include <pent/contact/surface.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace pent::contact {
namespace {

template <typename T>
class SurfaceTest : public testing::Test {};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(SurfaceTest, Dimensions);

TYPED_TEST(SurfaceTest, HasTheFacesOfItsFacetsOnce) {
    constexpr int kDim = TypeParam::value;
    const SimplexMesh<kDim> mesh = test::cube<kDim>(2);
    const Surface<kDim> surface = make_surface<kDim>(mesh.cells, mesh.vertex_count(), 10);
    std::set<std::set<std::uint32_t>> edges;
    std::map<std::set<std::uint32_t>, int> facets_at_ridge;
    for (Eigen::Index f = 0; f < surface.facets.cols(); ++f) {
        for (int i = 0; i < kDim; ++i) {
            for (int j = 0; j < i; ++j) {
                edges.insert({surface.facets(i, f), surface.facets(j, f)});
            }
            std::set<std::uint32_t> ridge(surface.facets.col(f).begin(),
                                          surface.facets.col(f).end());
            ridge.erase(surface.facets(i, f));
            ++facets_at_ridge[ridge];
        }
    }
    EXPECT_EQ(surface.edges.cols(), static_cast<Eigen::Index>(edges.size()));
    EXPECT_EQ(surface.ridges.cols(), static_cast<Eigen::Index>(facets_at_ridge.size()));
    for (Eigen::Index r = 0; r < surface.ridges.cols(); ++r) {
        const std::set<std::uint32_t> ridge(surface.ridges.col(r).begin(),
                                            surface.ridges.col(r).end());
        EXPECT_EQ(facets_at_ridge[ridge], 2);  // a closed surface
    }
    // All but the vertex in the middle.
    EXPECT_EQ(surface.vertices.cols(), mesh.vertex_count() - 1);
    EXPECT_EQ(surface.vertices.minCoeff(), 10);
    for (Eigen::Index i = 0; i < surface.vertices.cols(); ++i) {
        for (std::uint32_t k = surface.facet_begin[i]; k < surface.facet_begin[i + 1]; ++k) {
            const auto facet = surface.facets.col(surface.facet_of[k]);
            EXPECT_NE(std::find(facet.begin(), facet.end(), surface.vertices(0, i)), facet.end());
        }
    }
    EXPECT_EQ(static_cast<Eigen::Index>(surface.facet_of.size()), surface.facets.size());
}

TYPED_TEST(SurfaceTest, GivesItsSimplicesByTheirCorners) {
    constexpr int kDim = TypeParam::value;
    const SimplexMesh<kDim> mesh = test::cube<kDim>(1);
    const Surface<kDim> surface = make_surface<kDim>(mesh.cells, mesh.vertex_count());
    EXPECT_EQ(surface.template simplices<1>(), surface.vertices);
    EXPECT_EQ(surface.template simplices<2>(), surface.edges);
    EXPECT_EQ(surface.template simplices<kDim - 1>(), surface.ridges);
    EXPECT_EQ(surface.template simplices<kDim>(), surface.facets);
}

TYPED_TEST(SurfaceTest, OfNothingIsEmpty) {
    constexpr int kDim = TypeParam::value;
    const Surface<kDim> surface = make_surface<kDim>(Simplices<kDim + 1>(kDim + 1, 0), 0);
    EXPECT_EQ(surface.vertices.cols(), 0);
    EXPECT_EQ(surface.facets.cols(), 0);
    EXPECT_EQ(mean_edge_length<kDim>(surface, Positions<kDim>(kDim, 0)), 0);
}

}  // namespace
}  // namespace pent::contact
