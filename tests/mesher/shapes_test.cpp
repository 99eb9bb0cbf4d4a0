#include "support/messages.h"

#include <pent/facets.h>
#include <pent/mesher/edge_order.h>
#include <pent/mesher/links.h>
#include <pent/mesher/prove.h>
#include <pent/mesher/shapes.h>
#include <pent/mesher/straight_layers.h>
#include <pent/mesher/subdivide.h>
#include <pent/mesher/surface_check.h>

#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <set>

namespace pent::mesher {
namespace {

TEST(Box, IsFilledByEitherCut) {
    for (const CubeCut cut : {CubeCut::Paths, CubeCut::Corners}) {
        const auto plane = box<2>({3, 2}, {3, 4}, cut);
        const auto space = box<3>({3, 2, 2}, {3, 4, 5}, cut);
        const auto body = box<4>({3, 2, 1, 2}, {3, 4, 5, 6}, cut);
        EXPECT_TRUE(prove(plane, 12).holds());
        EXPECT_TRUE(prove(space, 60).holds());
        EXPECT_TRUE(prove(body, 360).holds());
        EXPECT_EQ(check_links(body).faulty, 0);
        EXPECT_EQ(plane.cell_count(), 6 * 2);
        EXPECT_EQ(space.cell_count(), 12 * (cut == CubeCut::Paths ? 6 : 5));
        EXPECT_EQ(body.cell_count(), 12 * (cut == CubeCut::Paths ? 24 : 16));
    }
}

TEST(Box, RefusesEmptyAndEndlessOnes) {
    const auto message = [](std::array<int, 2> count, std::array<double, 2> size) {
        return test::error_of([&] { static_cast<void>(box<2>(count, size)); });
    };
    test::expect_contains(message({0, 1}, {1, 1}), {"0 cubes along x"});
    test::expect_contains(message({1, 1}, {1, -1}), {"along y"});
    test::expect_contains(message({1, 1}, {1, std::nan("")}), {"along y"});
    test::expect_contains(message({2000000000, 2000000000}, {1, 1}), {"4294967295"});
}

TEST(Sphere, IsACleanSurfaceOfUnitPoints) {
    for (const int frequency : {1, 2, 3, 4, 7}) {
        const Surface surface = sphere(frequency);
        EXPECT_EQ(surface.triangle_count(), 20 * frequency * frequency);
        EXPECT_EQ(surface.point_count(), 10 * frequency * frequency + 2);
        const SurfaceReport report = check_surface(surface);
        EXPECT_TRUE(report.is_clean()) << describe(report);
        EXPECT_EQ(report.misoriented_edges.count, 0);
        EXPECT_NEAR((surface.points.colwise().norm().array() - 1).abs().maxCoeff(), 0, 1e-15);
    }
    // An icosahedron in the unit sphere; then the ball, from within, at second order.
    EXPECT_NEAR(enclosed_volume(sphere(1)), 2.536150710, 1e-9);
    const double whole = 4 * std::numbers::pi / 3;
    const double coarse = whole - enclosed_volume(sphere(8));
    const double fine = whole - enclosed_volume(sphere(16));
    EXPECT_NEAR(coarse / fine, 4, 0.1);
}

TEST(Sphere, RefusesFrequenciesOutOfRange) {
    for (const int frequency : {0, 1001}) {
        test::expect_contains(test::error_of([&] { static_cast<void>(sphere(frequency)); }),
                              {"frequency " + std::to_string(frequency), "expected 1 to 1000"});
    }
}

TEST(Ball, HasTheCountsOfTheNoodles) {
    const SimplexMesh<3> mesh = ball(4);
    EXPECT_EQ(mesh.vertex_count(), 163);
    EXPECT_EQ(mesh.cell_count(), 320);
    validate(mesh, "ball");
    const Proof proof = prove(mesh, enclosed_volume(sphere(4)));
    EXPECT_TRUE(proof.holds());
    EXPECT_EQ(proof.boundary_facets, 320);
}

template <typename Dimension>
class SubdivideInDimension : public testing::Test {};
template <int Dim>
using Constant = std::integral_constant<int, Dim>;
using Dimensions = testing::Types<Constant<2>, Constant<3>, Constant<4>>;
TYPED_TEST_SUITE(SubdivideInDimension, Dimensions);

TYPED_TEST(SubdivideInDimension, MakesEqualConformingChildren) {
    constexpr int kDim = TypeParam::value;
    std::array<int, kDim> count{};
    std::array<double, kDim> size{};
    count.fill(2);
    size.fill(1);
    for (const CubeCut cut : {CubeCut::Paths, CubeCut::Corners}) {
        SimplexMesh<kDim> coarse = box<kDim>(count, size, cut);
        coarse.regions.assign(coarse.cell_count(), 3);
        coarse.regions.back() = 4;
        coarse.fibers.setConstant(kDim, coarse.cell_count(), 1);
        coarse.fibers.row(0).setLinSpaced(1, static_cast<double>(coarse.cell_count()));
        for (const int k : {1, 2, 3}) {
            const SimplexMesh<kDim> fine = subdivide<kDim>(coarse, k);
            validate(fine, "finer");
            EXPECT_TRUE(prove(fine, 1).holds());
            const auto children = static_cast<Eigen::Index>(std::lround(std::pow(k, kDim)));
            ASSERT_EQ(fine.cell_count(), coarse.cell_count() * children);
            for (Eigen::Index cell = 0; cell < fine.cell_count(); ++cell) {
                EXPECT_NEAR(cell_volume<kDim>(fine.positions, fine.cells, cell) * std::pow(k, kDim),
                            cell_volume<kDim>(coarse.positions, coarse.cells, cell / children),
                            1e-15);
                EXPECT_EQ(fine.fibers.col(cell), coarse.fibers.col(cell / children));
            }
            EXPECT_EQ(fine.positions.leftCols(coarse.vertex_count()), coarse.positions);
            EXPECT_EQ(fine.regions.front(), 3);
            EXPECT_EQ(fine.regions.back(), 4);
        }
    }
}

// As if the base mesh had been subdivided first and then extruded to k times the layers: vertices
// of a column lie above one another, in layers of their own. A cell reaches over two slabs at most,
// which is what the simulator's preconditioner of columns takes.
TEST(Subdivide, HandsDownColumnsAndLayers) {
    const SimplexMesh<3> base = box<3>({2, 1, 1}, {2, 1, 1}, CubeCut::Corners);
    const OrderedCells<3> ordered =
        order_cells<3>(base, direct_edges<3>(base, rank_vertices<3>(base, VertexOrder::Index)));
    const SimplexMesh<4> coarse = extrude<4>(
        base, ordered, straight_layers<4>(Eigen::Vector4d(0, 0, 0, 1), 2, Anchor::Start));
    for (const int k : {2, 3}) {
        const SimplexMesh<4> fine = subdivide<4>(coarse, k);
        validate(fine, "finer");
        const SimplexMesh<3> fine_base = subdivide<3>(base, k);
        std::map<std::uint32_t, Eigen::Vector3d> place;
        std::set<std::pair<std::uint32_t, std::uint32_t>> taken;
        for (Eigen::Index v = 0; v < fine.vertex_count(); ++v) {
            const std::uint32_t column = fine.columns[v];
            const Eigen::Vector3d at = fine.positions.col(v).head<3>();
            EXPECT_LT((place.try_emplace(column, at).first->second - at).norm(), 1e-15);
            EXPECT_TRUE(taken.emplace(column, fine.layers[v]).second);
            EXPECT_NEAR(fine.positions(3, v), fine.layers[v] / (2.0 * k), 1e-15);
        }
        EXPECT_EQ(static_cast<Eigen::Index>(place.size()), fine_base.vertex_count());
        EXPECT_EQ(fine.vertex_count(), fine_base.vertex_count() * (2 * k + 1));
        for (Eigen::Index cell = 0; cell < fine.cell_count(); ++cell) {
            std::set<std::uint32_t> layers;
            for (const std::uint32_t v : fine.cells.col(cell)) {
                layers.insert(fine.layers[v]);
            }
            EXPECT_LE(*layers.rbegin() - *layers.begin(), 2U);
        }
    }
}

TEST(MakeQuadratic, LabelsTheChildrenOfEveryCell) {
    const SimplexMesh<4> coarse = box<4>({2, 1, 1, 1}, {2, 1, 1, 1}, CubeCut::Paths);
    const SimplexMesh<4> fine = make_quadratic<4>(coarse);
    EXPECT_EQ(fine.cells, subdivide<4>(coarse, 2).cells);
    ASSERT_EQ(fine.parents.size(), static_cast<std::size_t>(fine.cell_count()));
    for (Eigen::Index cell = 0; cell < fine.cell_count(); ++cell) {
        EXPECT_EQ(fine.parents[cell], cell / 16);
    }
    // Cut again they are no longer the children of anything.
    EXPECT_TRUE(subdivide<4>(fine, 2).parents.empty());
}

TEST(Subdivide, MakesTheCantileverOfThePaper) {
    // [shi2025] Table 1: 4 tesseracts in a row, each of 16 pentachora, every edge in 8 parts.
    const SimplexMesh<4> mesh = subdivide(box<4>({4, 1, 1, 1}, {4, 1, 1, 1}, CubeCut::Corners), 8);
    EXPECT_EQ(mesh.vertex_count(), 17589);
    EXPECT_EQ(mesh.cell_count(), 262144);
    const Proof proof = prove(mesh, 4);
    EXPECT_TRUE(proof.holds());
    EXPECT_EQ(proof.boundary_facets, 66560);
    const auto boundary = match_facets<4>(mesh.cells, mesh.vertex_count()).boundary;
    EXPECT_EQ(edges_of<3>(boundary).cols(), 77800);
}

}  // namespace
}  // namespace pent::mesher
