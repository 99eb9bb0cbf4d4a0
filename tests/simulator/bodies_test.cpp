#include "model/bodies.h"

#include "scenes.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <vector>

namespace pent::simulator {
namespace {

using test::bar;
using test::box_scene;

// Two bars of different length, the second of them moved and turned.
Scene two_bars() {
    Scene scene = box_scene<4>();
    scene.bodies.push_back(scene.bodies[0]);
    scene.bodies[1].name = "other";
    scene.bodies[1].material.density = 500;
    scene.bodies[1].place.scale = 2;
    scene.bodies[1].place.rotate = {{{0, 3}, 90}};
    scene.bodies[1].place.translate = Eigen::Vector4d(10, 0, 0, 0);
    return scene;
}

TEST(Bodies, AreOneMeshOneAfterTheOther) {
    const Bodies<4> bodies = make_bodies<4>(two_bars(), {bar(2), bar(3)});
    ASSERT_EQ(bodies.count(), 2U);
    EXPECT_EQ(bodies.vertices(0).begin, 0);
    EXPECT_EQ(bodies.vertices(1).begin, bar(2).vertex_count());
    EXPECT_EQ(bodies.vertex_count(), bar(2).vertex_count() + bar(3).vertex_count());
    EXPECT_EQ(bodies.cells().cols(), bar(2).cell_count() + bar(3).cell_count());
    for (std::size_t body = 0; body < 2; ++body) {
        const auto [begin, size] = bodies.vertices(body);
        const CellRange& range = bodies.ranges[body];
        const auto own = bodies.cells().middleCols(range.begin, range.end - range.begin);
        EXPECT_GE(own.minCoeff(), begin);
        EXPECT_LT(own.maxCoeff(), begin + size);
        for (const Eigen::Index vertex : {begin, begin + size - 1}) {
            EXPECT_EQ(bodies.body_of(static_cast<std::uint32_t>(vertex)), body);
        }
    }
}

// Twenty bytes a pentachoron: cells are there once where a mesh has them in their order already.
TEST(Bodies, HaveTheVerticesAndCellsOfASingleMeshOnce) {
    const SimplexMesh<4> mesh = bar(3);
    Scene scene = box_scene<4>();
    const Bodies<4> one = make_bodies<4>(scene, {mesh});
    EXPECT_EQ(one.cells().data(), one.meshes[0].cells.data());
    EXPECT_EQ(one.cells(), mesh.cells);
    EXPECT_EQ(one.rest().data(), one.meshes[0].positions.data());
    const Bodies<4> copy = one;
    EXPECT_EQ(copy.rest().data(), copy.meshes[0].positions.data());
    EXPECT_EQ(copy.cells().data(), copy.meshes[0].cells.data());
    EXPECT_EQ(make_bodies<4>(two_bars(), {bar(2), mesh}).cells().rightCols(mesh.cell_count()),
              (mesh.cells.array() + static_cast<std::uint32_t>(bar(2).vertex_count())).matrix());
    // Cells of a region come last.
    const HalfSpaceSelection front{.normal = Eigen::Vector4d(-1, 0, 0, 0),
                                   .offset = -mesh.positions.row(0).mean()};
    scene.bodies[0].regions = {
        {.name = "front", .select = {front}, .material = scene.bodies[0].material}};
    const Bodies<4> parts = make_bodies<4>(scene, {mesh});
    EXPECT_NE(parts.cells(), mesh.cells);
    EXPECT_EQ(parts.rest().data(), parts.meshes[0].positions.data());
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        EXPECT_EQ(parts.cells().col(cell), mesh.cells.col(parts.mesh_cell(0, cell)));
    }
}

// Scaled, then turned, then moved: x to w where a quarter turn takes it.
TEST(Bodies, AreWhereTheSceneHasThem) {
    const Bodies<4> bodies = make_bodies<4>(two_bars(), {bar(2), bar(3)});
    const auto [begin, size] = bodies.vertices(1);
    const auto placed = bodies.rest().middleCols(begin, size);
    const SimplexMesh<4> mesh = bar(3);
    EXPECT_LT((placed.row(3) - 2 * mesh.positions.row(0)).norm(), 1e-14);
    EXPECT_LT((placed.row(0).array() - 10 + 2 * mesh.positions.row(3).array()).matrix().norm(),
              1e-14);
    EXPECT_EQ(Positions<4>(bodies.meshes[1].positions), Positions<4>(placed));
}

// A fifth of the mass of each cell at each of its corners: in all the density times the volume.
TEST(Bodies, HaveTheMassOfTheirVolume) {
    const Bodies<4> bodies = make_bodies<4>(two_bars(), {bar(2), bar(3)});
    const auto mass = [&](std::size_t body) {
        const auto [begin, size] = bodies.vertices(body);
        return bodies.masses.segment(begin, size).sum();
    };
    const double volume = 0.25 * 0.5 * 0.5 * 0.5;  // of a bar a cell long
    EXPECT_NEAR(mass(0), two_bars().bodies[0].material.density * 2 * volume, 1e-12 * mass(0));
    EXPECT_NEAR(mass(1), 500 * 3 * volume * 16, 1e-12 * mass(1));
    EXPECT_GT(bodies.masses.minCoeff(), 0);
}

// Labels in any order, with gaps: what has one label is one column, and no other body's.
TEST(Bodies, NumberTheirColumnsOneAfterTheOtherHoweverTheseAreLabeled) {
    SimplexMesh<3> mesh = pent::test::kuhn_box<3>({1, 1, 1}, {1, 1, 1});
    mesh.columns = {9, 4, 9, 30, 4, 7, 2, 7};
    const std::vector<std::uint32_t> columns = number_columns<3>({mesh, mesh}).columns;
    ASSERT_EQ(columns.size(), 16);
    std::set<std::uint32_t> all;
    for (std::size_t a = 0; a < 16; ++a) {
        all.insert(columns[a]);
        for (std::size_t b = 0; b < 16; ++b) {
            const bool is_one = a / 8 == b / 8 && mesh.columns[a % 8] == mesh.columns[b % 8];
            EXPECT_EQ(columns[a] == columns[b], is_one) << a << " " << b;
        }
    }
    EXPECT_EQ(all.size(), 10);
    EXPECT_EQ(*all.rbegin(), 9);
}

TEST(Bodies, StartWithTheVelocitiesOfTheScene) {
    Scene scene = two_bars();
    scene.bodies[1].velocity = Eigen::Vector4d(1, 2, 3, 4);
    const Bodies<4> bodies = make_bodies<4>(scene, {bar(2), bar(3)});
    const Positions<4> velocities = start_velocities(scene, bodies);
    const auto [begin, size] = bodies.vertices(1);
    EXPECT_EQ(velocities.leftCols(begin).norm(), 0);
    EXPECT_EQ((velocities.rightCols(size).colwise() - Eigen::Vector4d(1, 2, 3, 4)).norm(), 0);
}

}  // namespace
}  // namespace pent::simulator
