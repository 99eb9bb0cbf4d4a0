#include "model/append_bodies.h"

#include "potential_laws.h"

#include <pent/simulator/words.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

// Bodies by way of make_bodies(), which begins with appending them.

namespace pent::simulator {
namespace {

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;

template <typename T>
class AppendBodies : public testing::Test {};
TYPED_TEST_SUITE(AppendBodies, Dimensions);

constexpr ElementKind kKinds[] = {ElementKind::Linear, ElementKind::Quadratic};

// Two boxes; in the second all that is above the middle is heavier.
template <int Dim>
Scene half_heavy(ElementKind kind) {
    Scene scene = test::two_cubes<Dim>(0.3);
    scene.contact.reset();
    scene.solver.elements = kind;
    Region heavy;
    heavy.name = "heavy";
    const double middle = scene.bodies[1].place.translate[1] + 0.25;
    heavy.select = {HalfSpaceSelection{-Eigen::VectorXd::Unit(Dim, 1), -middle}};
    heavy.material = scene.bodies[1].material;
    heavy.material.density = 3000;
    scene.bodies[1].regions = {heavy};
    return scene;
}

template <int Dim>
Bodies<Dim> half_heavy_bodies(ElementKind kind) {
    const Scene scene = half_heavy<Dim>(kind);
    const SimplexMesh<Dim> cube =
        test::cube_for<Dim>(scene, kind == ElementKind::Quadratic ? 4 : 2);
    return make_bodies<Dim>(scene, {cube, cube});
}

// Each cell is the cell of its mesh that mesh_cell() names, and none is left out.
TYPED_TEST(AppendBodies, HasEveryCellOfEveryMeshOnce) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind : kKinds) {
        const Bodies<kDim> bodies = half_heavy_bodies<kDim>(kind);
        for (std::size_t body = 0; body < 2; ++body) {
            const auto [begin, size] = bodies.cells_of(body);
            std::set<std::uint32_t> seen;
            for (Eigen::Index cell = begin; cell < begin + size; ++cell) {
                const std::uint32_t own = bodies.mesh_cell(body, cell);
                seen.insert(own);
                const auto first = static_cast<std::uint32_t>(bodies.first_vertex[body]);
                EXPECT_TRUE((bodies.cells().col(cell).array() - first
                             == bodies.meshes[body].cells.col(own).array())
                                .all());
            }
            EXPECT_EQ(static_cast<Eigen::Index>(seen.size()), bodies.meshes[body].cell_count());
        }
    }
}

// A range for each material of each body, one behind the other, with the cells that are where the
// selection says: the middle of a heavy cell is above 0.25 m over the low side of its body.
TYPED_TEST(AppendBodies, PutsCellsOfOneMaterialBehindOneAnother) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind : kKinds) {
        const Bodies<kDim> bodies = half_heavy_bodies<kDim>(kind);
        ASSERT_EQ(bodies.ranges.size(), 3U);
        Eigen::Index end = 0;
        for (const CellRange& range : bodies.ranges) {
            EXPECT_EQ(range.begin, end);
            end = range.end;
            EXPECT_GT(range.end, range.begin);
        }
        EXPECT_EQ(end, bodies.cells().cols());
        const double low = bodies.meshes[1].positions.row(1).minCoeff();
        for (const CellRange& range : {bodies.ranges[1], bodies.ranges[2]}) {
            EXPECT_EQ(range.body, 1U);
            const bool is_heavy = range.region == 1;
            EXPECT_EQ(range.material.density == 3000, is_heavy);
            for (Eigen::Index cell = range.begin; cell < range.end; ++cell) {
                double height = 0;
                for (const std::uint32_t v : bodies.cells().col(cell)) {
                    height += (bodies.rest()(1, v) - low) / (kDim + 1);
                }
                EXPECT_EQ(height > 0.25, is_heavy);
            }
        }
    }
}

// Linear elements need no quadratic cells; of quadratic ones each has 2^d cells as children, which
// lie within it and are of the same material.
TYPED_TEST(AppendBodies, NamesTheParentOfEveryCell) {
    constexpr int kDim = TypeParam::value;
    EXPECT_EQ(half_heavy_bodies<kDim>(ElementKind::Linear).quadratic.nodes.cols(), 0);
    EXPECT_TRUE(half_heavy_bodies<kDim>(ElementKind::Linear).quadratic.parents.empty());
    const Bodies<kDim> bodies = half_heavy_bodies<kDim>(ElementKind::Quadratic);
    const QuadraticCells<kDim>& quadratic = bodies.quadratic;
    EXPECT_EQ(quadratic.nodes.cols() << kDim, bodies.cells().cols());
    ASSERT_EQ(quadratic.ranges.size(), bodies.ranges.size());
    ASSERT_EQ(static_cast<Eigen::Index>(quadratic.parents.size()), bodies.cells().cols());
    std::vector<int> children(static_cast<std::size_t>(quadratic.nodes.cols()), 0);
    for (std::size_t i = 0; i < quadratic.ranges.size(); ++i) {
        const CellRange& range = quadratic.ranges[i];
        EXPECT_EQ(range.material.density, bodies.ranges[i].material.density);
        for (Eigen::Index cell = bodies.ranges[i].begin; cell < bodies.ranges[i].end; ++cell) {
            const std::uint32_t parent = quadratic.parents[static_cast<std::size_t>(cell)];
            EXPECT_GE(parent, range.begin);
            EXPECT_LT(parent, range.end);
            ++children[parent];
            const auto nodes = quadratic.nodes.col(parent);
            for (const std::uint32_t vertex : bodies.cells().col(cell)) {
                EXPECT_NE(std::find(nodes.begin(), nodes.end(), vertex), nodes.end());
            }
        }
    }
    EXPECT_EQ(std::count(children.begin(), children.end(), 1 << kDim), quadratic.nodes.cols());
}

}  // namespace
}  // namespace pent::simulator
