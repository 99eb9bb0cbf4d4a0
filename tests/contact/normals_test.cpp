#include "normals.h"

#include "scenes.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace pent::contact {
namespace {

template <typename T>
class NormalsTest : public testing::Test {};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(NormalsTest, Dimensions);

TYPED_TEST(NormalsTest, PointOutwardAndIntegrateToTheVolume) {
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

TYPED_TEST(NormalsTest, AreNormalToColumnsAndAsLongAsTheirVolume) {
    constexpr int kDim = TypeParam::value;
    Positions<kDim> columns = Positions<kDim>::Zero(kDim, kDim);
    test::shake<kDim>(columns, 1, 7);
    const Eigen::Matrix<double, kDim, kDim - 1> edges = columns.template leftCols<kDim - 1>();
    const Vector<kDim> normal = normal_to(edges);
    EXPECT_LT((edges.transpose() * normal).norm(), 1e-15);
    const Eigen::Matrix<double, kDim, kDim> square = columns;
    EXPECT_NEAR(normal.dot(columns.col(kDim - 1)), square.determinant(), 1e-15);
}

}  // namespace
}  // namespace pent::contact
