#include "support/kuhn_box.h"

#include <pent/facets.h>
#include <pent/geometry.h>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <array>
#include <numbers>
#include <type_traits>

namespace pent {
namespace {

template <typename T>
class Geometry : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(Geometry, Dimensions);

// n . v = det[v, edges] for every v, and |n|^2 is Gram's determinant of the edges.
TYPED_TEST(Geometry, NormalOfAFacetIsThatOfTheDeterminant) {
    constexpr int kDim = TypeParam::value;
    using Square = Eigen::Matrix<double, kDim, kDim>;
    for (int trial = 0; trial < 10; ++trial) {
        const Square corners = Square::Random();
        const Eigen::Matrix<double, kDim, kDim - 1> edges =
            corners.template rightCols<kDim - 1>().colwise() - corners.col(0);
        const Eigen::Vector<double, kDim> normal = facet_normal<kDim>(corners);
        EXPECT_NEAR(normal.squaredNorm(), (edges.transpose() * edges).determinant(), 1e-13);
        for (int axis = 0; axis < kDim; ++axis) {
            Square all;
            all << Eigen::Vector<double, kDim>::Unit(axis), edges;
            EXPECT_NEAR(normal[axis], all.determinant(), 1e-14);
        }
    }
    EXPECT_EQ(facet_normal<kDim>(Square::Ones()).norm(), 0);  // collapsed
}

// The facets of the boundary of a box face away from its middle, and their sizes are its sides'.
TYPED_TEST(Geometry, NormalsOfABoundaryFaceOutward) {
    constexpr int kDim = TypeParam::value;
    std::array<int, kDim> counts{};
    std::array<double, kDim> sizes{};
    counts.fill(2);
    sizes.fill(1);
    const SimplexMesh<kDim> mesh = test::kuhn_box<kDim>(counts, sizes);
    const FacetMatch<kDim> match = match_facets<kDim>(mesh.cells, mesh.vertex_count());
    double size = 0;
    for (const auto& facet : match.boundary.colwise()) {
        Eigen::Matrix<double, kDim, kDim> corners;
        for (int k = 0; k < kDim; ++k) {
            corners.col(k) = mesh.positions.col(facet[k]);
        }
        const Eigen::Vector<double, kDim> normal = facet_normal<kDim>(corners);
        const Eigen::Vector<double, kDim> middle = corners.rowwise().mean();
        EXPECT_GT(normal.dot(middle - Eigen::Vector<double, kDim>::Constant(0.5)), 0);
        size += normal.norm() / (kDim == 3 ? 2 : 6);
    }
    EXPECT_NEAR(size, 2 * kDim, 1e-13);
}

TYPED_TEST(Geometry, EdgesOfACellSpanItsVolume) {
    constexpr int kDim = TypeParam::value;
    std::array<int, kDim> counts{};
    std::array<double, kDim> sizes{};
    counts.fill(1);
    sizes.fill(1);
    const SimplexMesh<kDim> mesh = test::kuhn_box<kDim>(counts, sizes);
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        EXPECT_NEAR(edge_matrix<kDim>(mesh.positions, mesh.cells, cell).determinant(), 1, 1e-15);
    }
}

// A quarter takes the first axis to the second and this to minus the first; turns in a plane add
// up; and what is left where it was, in every plane, either way round.
TYPED_TEST(Geometry, RotationOfAPlaneTakesOneAxisTowardsTheOther) {
    constexpr int kDim = TypeParam::value;
    using Square = Eigen::Matrix<double, kDim, kDim>;
    using Axis = Eigen::Vector<double, kDim>;
    for (int from = 0; from < kDim; ++from) {
        for (int to = 0; to < kDim; ++to) {
            if (from == to) {
                continue;
            }
            const Square quarter = plane_rotation<kDim>(from, to, std::numbers::pi / 2);
            EXPECT_LT((quarter * Axis::Unit(from) - Axis::Unit(to)).norm(), 1e-15);
            EXPECT_LT((quarter * Axis::Unit(to) + Axis::Unit(from)).norm(), 1e-15);
            for (int axis = 0; axis < kDim; ++axis) {
                if (axis != from && axis != to) {
                    EXPECT_EQ(Axis(quarter * Axis::Unit(axis)), Axis(Axis::Unit(axis)));
                }
            }
            const Square one = plane_rotation<kDim>(from, to, 0.7);
            EXPECT_LT((one.transpose() * one - Square::Identity()).norm(), 1e-15);
            EXPECT_NEAR(one.determinant(), 1, 1e-15);
            EXPECT_LT(
                (one * plane_rotation<kDim>(from, to, 1.9) - plane_rotation<kDim>(from, to, 2.6))
                    .norm(),
                1e-15);
            EXPECT_EQ(plane_rotation<kDim>(to, from, -0.7), one);
        }
    }
}

}  // namespace
}  // namespace pent
