#include "scenes.h"

#include <pent/contact/surface.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace pent::contact {
namespace {

template <typename T>
class SurfaceTest : public testing::Test {
protected:
    static BoxTree facet_tree(const Surface<T::value>& surface,
                              const Positions<T::value>& positions) {
        return BoxTree(boxes_around<T::value, T::value>(surface.facets, positions, 0));
    }
};

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

TYPED_TEST(SurfaceTest, HasOutwardNormalsThatIntegrateToTheVolume) {
    constexpr int kDim = TypeParam::value;
    SimplexMesh<kDim> mesh = test::cube<kDim>(2);
    mesh.positions = test::tilt<kDim>() * mesh.positions;
    test::shake<kDim>(mesh.positions, 0.05, 1);
    const Surface<kDim> surface = make_surface<kDim>(mesh.cells, mesh.vertex_count());
    Vector<kDim> sum = Vector<kDim>::Zero();
    double flux = 0;  // of x, which is Dim times the volume
    for (Eigen::Index f = 0; f < surface.facets.cols(); ++f) {
        Corners<kDim, kDim> corners;
        for (int i = 0; i < kDim; ++i) {
            corners.col(i) = mesh.positions.col(surface.facets(i, f));
        }
        const Vector<kDim> normal = facet_normal<kDim>(corners);
        sum += normal;
        flux += normal.dot(corners.col(0));
        for (int i = 1; i < kDim; ++i) {
            EXPECT_NEAR(normal.dot(corners.col(i) - corners.col(0)), 0, 1e-14);
        }
    }
    const double factorial = kDim == 3 ? 6 : 24;
    EXPECT_LT(sum.norm(), 1e-12);  // some hundred terms of size 1
    EXPECT_NEAR(flux / factorial, total_volume(mesh), 1e-12);
    const Positions<kDim> normals = vertex_normals<kDim>(surface, mesh.positions);
    const Vector<kDim> center = mesh.positions.rowwise().mean();
    for (Eigen::Index i = 0; i < normals.cols(); ++i) {
        EXPECT_NEAR(normals.col(i).norm(), 1, 1e-14);
        EXPECT_GT(normals.col(i).dot(mesh.positions.col(surface.vertices(0, i)) - center), 0);
    }
}

TYPED_TEST(SurfaceTest, GoesRoundEveryPointInsideOnce) {
    constexpr int kDim = TypeParam::value;
    for (const bool is_tilted : {false, true}) {
        SimplexMesh<kDim> mesh = test::cube<kDim>(2);
        // On the lattice every ray from a lattice point runs along edges of the surface.
        const Eigen::Matrix<double, kDim, kDim> rotation =
            is_tilted ? test::tilt<kDim>() : Eigen::Matrix<double, kDim, kDim>::Identity();
        mesh.positions = rotation * mesh.positions;
        const Surface<kDim> surface = make_surface<kDim>(mesh.cells, mesh.vertex_count());
        const BoxTree tree = TestFixture::facet_tree(surface, mesh.positions);
        const int steps = 9;  // -0.5, -0.125, .. through 0, 1, 2 and between
        int count = 1;
        for (int axis = 0; axis < kDim; ++axis) {
            count *= steps;
        }
        int compared = 0;
        for (int k = 0; k < count; ++k) {
            Vector<kDim> local;
            bool is_on_surface = false;
            bool is_inside = true;
            for (int axis = 0, rest = k; axis < kDim; ++axis, rest /= steps) {
                local[axis] = -1 + 0.5 * (rest % steps);
                is_inside = is_inside && local[axis] > 0 && local[axis] < 2;
                is_on_surface = is_on_surface || local[axis] == 0 || local[axis] == 2;
            }
            const bool is_outside_anyway = local.minCoeff() < 0 || local.maxCoeff() > 2;
            if (is_on_surface && !is_outside_anyway) {
                continue;
            }
            ++compared;
            EXPECT_EQ(winding_number<kDim>(surface, tree, mesh.positions, rotation * local),
                      is_inside ? 1 : 0)
                << local.transpose();
        }
        EXPECT_GT(compared, count / 2);
    }
}

TYPED_TEST(SurfaceTest, CountsOverlapsAndInsideOut) {
    constexpr int kDim = TypeParam::value;
    const SimplexMesh<kDim> mesh = test::cube<kDim>(2);
    Simplices<kDim + 1> cells(kDim + 1, 2 * mesh.cell_count());
    cells << mesh.cells, (mesh.cells.array() + mesh.vertex_count()).matrix();
    Positions<kDim> positions(kDim, 2 * mesh.vertex_count());
    positions << mesh.positions, (mesh.positions.array() + 0.75).matrix();
    const Surface<kDim> twice = make_surface<kDim>(cells, positions.cols());
    const BoxTree tree = TestFixture::facet_tree(twice, positions);
    EXPECT_EQ(winding_number<kDim>(twice, tree, positions, Vector<kDim>::Constant(1.5)), 2);
    EXPECT_EQ(winding_number<kDim>(twice, tree, positions, Vector<kDim>::Constant(0.5)), 1);
    Positions<kDim> inside_out = mesh.positions;
    inside_out.row(0) *= -1;
    const Surface<kDim> surface = make_surface<kDim>(mesh.cells, mesh.vertex_count());
    const BoxTree inverted = TestFixture::facet_tree(surface, inside_out);
    Vector<kDim> point = Vector<kDim>::Constant(0.6);
    point[0] = -0.7;
    EXPECT_EQ(winding_number<kDim>(surface, inverted, inside_out, point), -1);
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
