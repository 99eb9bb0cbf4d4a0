#include "support/kuhn_box.h"

#include <pent/mesher/prove.h>

#include <gtest/gtest.h>

namespace pent::mesher {
namespace {

TEST(Prove, AcceptsBoxesInEveryDimension) {
    // Facets of a box of 2^Dim cubes: on each of 2 Dim sides, 2^(Dim-1) cubes of (Dim-1)! facets.
    const Proof plane = prove(test::kuhn_box<2>({2, 2}, {1, 2}), 2);
    EXPECT_TRUE(plane.holds());
    EXPECT_EQ(plane.boundary_facets, 8);
    const Proof space = prove(test::kuhn_box<3>({2, 2, 2}, {1, 2, 3}), 6);
    EXPECT_TRUE(space.holds());
    EXPECT_EQ(space.boundary_facets, 6 * 4 * 2);
    const Proof body = prove(test::kuhn_box<4>({2, 2, 2, 2}, {1, 2, 3, 4}), 24);
    EXPECT_TRUE(body.holds());
    EXPECT_EQ(body.boundary_facets, 8 * 8 * 6);
    EXPECT_EQ(2 * body.interior_facets + body.boundary_facets, 5 * body.cells);
    EXPECT_DOUBLE_EQ(body.boundary_volume, 24);
}

TEST(Prove, HoldsFarFromTheOrigin) {
    SimplexMesh<4> mesh = test::kuhn_box<4>({3, 3, 3, 3}, {1, 1, 1, 1});
    mesh.positions.array() += 1e7;
    EXPECT_TRUE(prove(mesh).holds());
    EXPECT_TRUE(prove(mesh, 1).holds());
}

TEST(Prove, NoticesAWrongVolume) {
    const SimplexMesh<4> mesh = test::kuhn_box<4>({2, 2, 2, 2}, {1, 1, 1, 1});
    EXPECT_FALSE(prove(mesh, 1 + 1e-9).holds());
    EXPECT_NE(describe_faults(prove(mesh, 1 + 1e-9), 4), "");
    EXPECT_EQ(describe_faults(prove(mesh, 1), 4), "");
}

TEST(Prove, NoticesACellThatIsThereTwice) {
    SimplexMesh<3> mesh = test::kuhn_box<3>({2, 2, 2}, {1, 1, 1});
    mesh.cells.conservativeResize(4, mesh.cell_count() + 1);
    mesh.cells.rightCols<1>() = mesh.cells.col(7);
    const Proof proof = prove(mesh);
    EXPECT_FALSE(proof.holds());
    EXPECT_GT(proof.faulty_facets, 0);
}

TEST(Prove, NoticesABoundaryThatMeetsItself) {
    // Two triangles of a square that share one corner only: there the boundary runs through twice.
    SimplexMesh<2> fans;
    fans.positions.resize(2, 5);
    fans.positions << 0, 1, 0, -1, 0, 0, 0, 1, 0, -1;
    fans.cells.resize(3, 2);
    fans.cells << 0, 0, 1, 3, 2, 4;
    EXPECT_EQ(prove(fans).faulty_ridges, 1);
    // Two cubes of a 2 x 2 x 1 box that share one edge only.
    SimplexMesh<3> mesh = test::kuhn_box<3>({2, 2, 1}, {1, 1, 1});
    Simplices<4> kept(4, 12);
    kept << mesh.cells.leftCols<6>(), mesh.cells.rightCols<6>();
    mesh.cells = kept;
    EXPECT_EQ(prove(mesh).faulty_ridges, 1);
    EXPECT_FALSE(prove(mesh).holds());
}

}  // namespace
}  // namespace pent::mesher
