#include "support/kuhn_box.h"
#include "support/messages.h"

#include <pent/facets.h>
#include <pent/mesher/edge_order.h>
#include <pent/mesher/straight_layers.h>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace pent::mesher {
namespace {

template <int Dim>
OrderedCells<Dim> ordered(const SimplexMesh<Dim>& mesh, const std::vector<std::uint32_t>& ranks) {
    return order_cells<Dim>(mesh, direct_edges<Dim>(mesh, ranks));
}

std::vector<std::uint32_t> counted(Eigen::Index count) {
    std::vector<std::uint32_t> ranks(count);
    std::iota(ranks.begin(), ranks.end(), 0U);
    return ranks;
}

// The segment from 0 to 1 with `count` vertices, for extrusions to the plane.
template <int Dim>
SimplexMesh<Dim> base_mesh() {
    if constexpr (Dim == 1) {
        SimplexMesh<1> mesh;
        mesh.positions = Eigen::RowVectorXd::LinSpaced(4, 0, 1);
        mesh.cells.resize(2, 3);
        mesh.cells << 0, 1, 2, 1, 2, 3;
        return mesh;
    } else {
        std::array<int, Dim> count{};
        std::array<double, Dim> size{};
        count.fill(2);
        size.fill(1);
        return test::kuhn_box<Dim>(count, size);
    }
}

template <typename Dimension>
class ExtrudeInDimension : public testing::Test {};
template <int Dim>
using Constant = std::integral_constant<int, Dim>;
using Dimensions = testing::Types<Constant<2>, Constant<3>, Constant<4>>;
TYPED_TEST_SUITE(ExtrudeInDimension, Dimensions);

TYPED_TEST(ExtrudeInDimension, FillsThePrismOfOneSimplexUnderEveryOrder) {
    constexpr int kDim = TypeParam::value;
    SimplexMesh<kDim - 1> simplex;
    simplex.positions.setZero(kDim - 1, kDim);
    simplex.positions.rightCols(kDim - 1).setIdentity();
    simplex.cells.resize(kDim, 1);
    std::iota(simplex.cells.data(), simplex.cells.data() + kDim, 0U);
    double factorial = 1;
    for (int i = 2; i < kDim; ++i) {
        factorial *= i;
    }
    std::vector<std::uint32_t> ranks = counted(kDim);
    Eigen::Vector<double, kDim> up = Eigen::Vector<double, kDim>::Zero();
    up[kDim - 1] = 3;
    do {
        for (const double sign : {1.0, -1.0}) {
            const SimplexMesh<kDim> mesh = extrude<kDim>(simplex, ordered(simplex, ranks),
                                                         straight_layers<kDim>(sign * up, 3));
            EXPECT_EQ(mesh.cell_count(), 3 * kDim);
            for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
                // All simplices of a prism have the same volume: 1 / Dim of it.
                EXPECT_NEAR(cell_volume<kDim>(mesh.positions, mesh.cells, cell),
                            1 / factorial / kDim, 1e-15);
            }
        }
    } while (std::next_permutation(ranks.begin(), ranks.end()));
}

TYPED_TEST(ExtrudeInDimension, ConformsForEveryRankingDirectionAndAlternation) {
    constexpr int kDim = TypeParam::value;
    const SimplexMesh<kDim - 1> base = base_mesh<kDim - 1>();
    std::mt19937 random(5);
    std::vector<std::uint32_t> ranks = counted(base.vertex_count());
    Eigen::Vector<double, kDim> direction = Eigen::Vector<double, kDim>::Constant(0.25);
    for (int round = 0; round < 8; ++round) {
        std::shuffle(ranks.begin(), ranks.end(), random);
        direction[kDim - 1] = round % 2 == 0 ? 0.5 : -0.5;
        const SimplexMesh<kDim> mesh = extrude<kDim>(
            base, ordered(base, ranks), straight_layers<kDim>(direction, 3, Anchor::Start),
            {.alternate = round % 4 < 2});
        validate(mesh, "extrusion");
        EXPECT_NEAR(total_volume(mesh), 0.5, 1e-14);  // base volume 1 times |height|
        const FacetMatch<kDim> match = match_facets<kDim>(mesh.cells, mesh.vertex_count());
        EXPECT_TRUE(match.is_conforming());
        // Every base cell has a bottom and a top; every boundary facet of the base a side of slabs.
        Eigen::Index base_boundary = 2;
        if constexpr (kDim > 2) {
            base_boundary = match_facets<kDim - 1>(base.cells, base.vertex_count()).boundary.cols();
        }
        EXPECT_EQ(match.boundary.cols(), 2 * base.cell_count() + 3 * (kDim - 1) * base_boundary);
    }
}

TYPED_TEST(ExtrudeInDimension, NumbersVerticesAlongTheColumns) {
    constexpr int kDim = TypeParam::value;
    const SimplexMesh<kDim - 1> base = base_mesh<kDim - 1>();
    Eigen::Vector<double, kDim> up = Eigen::Vector<double, kDim>::Zero();
    up[kDim - 1] = 2;
    const SimplexMesh<kDim> mesh = extrude<kDim>(base, ordered(base, counted(base.vertex_count())),
                                                 straight_layers<kDim>(up, 4));
    ASSERT_EQ(mesh.vertex_count(), 5 * base.vertex_count());
    for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
        EXPECT_EQ(mesh.columns[v], v / 5);
        EXPECT_EQ(mesh.layers[v], v % 5);
        EXPECT_EQ(mesh.positions.col(v).template head<kDim - 1>(), base.positions.col(v / 5));
        EXPECT_EQ(mesh.positions(kDim - 1, v), -1 + 0.5 * static_cast<double>(v % 5));
    }
}

TYPED_TEST(ExtrudeInDimension, ClosesItsEndsInPoints) {
    constexpr int kDim = TypeParam::value;
    SimplexMesh<kDim - 1> base = base_mesh<kDim - 1>();
    base.regions.resize(base.cell_count());
    std::iota(base.regions.begin(), base.regions.end(), std::uint16_t{0});
    Eigen::Vector<double, kDim> up = Eigen::Vector<double, kDim>::Zero();
    up[kDim - 1] = 4;
    for (const int ends : {1, 2, 3}) {
        for (const int slabs : {1, 2, 4}) {
            if (slabs == 1 && ends == 3) {
                continue;
            }
            for (const double sign : {1.0, -1.0}) {
                std::vector<Layer<kDim>> layers = straight_layers<kDim>(sign * up, slabs);
                if ((ends & 1) != 0) {
                    layers.front().linear.setZero();
                }
                if ((ends & 2) != 0) {
                    layers.back().linear.setZero();
                }
                const SimplexMesh<kDim> mesh =
                    extrude<kDim>(base, ordered(base, counted(base.vertex_count())), layers);
                validate(mesh, "closed shape");
                EXPECT_TRUE(match_facets<kDim>(mesh.cells, mesh.vertex_count()).is_conforming());
                // A cone has 1 / Dim of the volume of its prism.
                const int cones = ends == 3 ? 2 : 1;
                const double expected = 4.0 / slabs * (slabs - cones + cones / double{kDim});
                EXPECT_NEAR(total_volume(mesh), expected, 1e-13);
                EXPECT_EQ(mesh.regions.size(), static_cast<std::size_t>(mesh.cell_count()));
                EXPECT_EQ(mesh.regions.back(), base.regions.back());
            }
        }
    }
}

TEST(Extrude, RefusesMoreVerticesThanCanBeNumbered) {
    SimplexMesh<3> base;
    base.positions.setZero(3, 65536);
    const std::vector<Layer<4>> layers = straight_layers<4>(Eigen::Vector4d::Unit(3), 65536);
    test::expect_contains(
        test::error_of([&] { static_cast<void>(extrude<4>(base, OrderedCells<3>(), layers)); }),
        {"an extrusion to 4295032832 vertices", "at most 4294967295"});
}

TEST(StraightLayers, AreSymmetricToTheLastBit) {
    const Eigen::Vector4d direction(0.1, 0.2, 0.3, 0.7);
    for (const int slabs : {1, 2, 3, 7, 10}) {
        const auto layers = straight_layers<4>(direction, slabs);
        for (int l = 0; l <= slabs; ++l) {
            EXPECT_EQ(layers[l].offset, -layers[slabs - l].offset);
        }
        const auto from_start = straight_layers<4>(direction, slabs, Anchor::Start);
        EXPECT_EQ(from_start.front().offset, Eigen::Vector4d::Zero());
        EXPECT_EQ(from_start.back().offset, direction);
    }
}

TEST(AutomaticSlabs, AreSevenTenthsOfAnEdgeHighAndAtLeastOne) {
    EXPECT_EQ(automatic_slabs(7, 1), 10);
    EXPECT_EQ(automatic_slabs(0.01, 1), 1);
    EXPECT_EQ(automatic_slabs(0.7 * 2.49, 1), 2);
    EXPECT_EQ(automatic_slabs(1e300, 1e-300), 1'000'000);
}

TEST(MeanEdge, CountsEachEdgeOnce) {
    // A unit square of two triangles: four sides and one diagonal.
    EXPECT_DOUBLE_EQ(mean_edge<2>(test::kuhn_box<2>({1, 1}, {1, 1})), (4 + std::sqrt(2.0)) / 5);
}

}  // namespace
}  // namespace pent::mesher
