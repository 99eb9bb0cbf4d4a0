#include "support/kuhn_box.h"

#include <pent/mesher/links.h>

#include <gtest/gtest.h>

namespace pent::mesher {
namespace {

TEST(CheckLinks, FindsSpheresAroundEveryVertexOfABox) {
    EXPECT_EQ(check_links(test::kuhn_box<2>({3, 3}, {1, 1})).boundary_vertices, 12);
    EXPECT_EQ(check_links(test::kuhn_box<3>({3, 3, 3}, {1, 1, 1})).boundary_vertices, 64 - 8);
    EXPECT_EQ(check_links(test::kuhn_box<4>({3, 3, 3, 3}, {1, 1, 1, 1})).boundary_vertices,
              256 - 16);
    EXPECT_EQ(check_links(test::kuhn_box<2>({3, 3}, {1, 1})).faulty, 0);
    EXPECT_EQ(check_links(test::kuhn_box<3>({3, 3, 3}, {1, 1, 1})).faulty, 0);
    EXPECT_EQ(check_links(test::kuhn_box<4>({3, 3, 3, 3}, {1, 1, 1, 1})).faulty, 0);
}

// The cells of a box in the cubes whose numbers are kept; the first axis counts fastest.
template <int Dim>
SimplexMesh<Dim> some_cubes(SimplexMesh<Dim> box, const std::vector<int>& cubes, int per_cube) {
    Simplices<Dim + 1> kept(Dim + 1, cubes.size() * per_cube);
    for (std::size_t i = 0; i < cubes.size(); ++i) {
        kept.middleCols(i * per_cube, per_cube) =
            box.cells.middleCols(cubes[i] * per_cube, per_cube);
    }
    box.cells = kept;
    return box;
}

TEST(CheckLinks, NoticesCubesThatTouchInOnePoint) {
    const LinkReport plane = check_links(some_cubes(test::kuhn_box<2>({2, 2}, {1, 1}), {0, 3}, 2));
    EXPECT_EQ(plane.faulty, 1);
    EXPECT_EQ(plane.first_faulty, 4);
    EXPECT_EQ(plane.unused_vertices, 2);
    const LinkReport space =
        check_links(some_cubes(test::kuhn_box<3>({2, 2, 2}, {1, 1, 1}), {0, 7}, 6));
    EXPECT_EQ(space.faulty, 1);
    EXPECT_EQ(space.first_faulty, 13);
    const LinkReport body =
        check_links(some_cubes(test::kuhn_box<4>({2, 2, 2, 2}, {1, 1, 1, 1}), {0, 15}, 24));
    EXPECT_EQ(body.faulty, 1);
    EXPECT_EQ(body.first_faulty, 40);
}

TEST(CheckLinks, NoticesBodiesThatTouchAlongAClosedCurve) {
    // In the plane of x and y the middle square of 3 x 3, and the 8 squares around it, each times a
    // square of z and w: the two squares of z and w share a point, so the bodies share the edges of
    // the middle square. Around its corners are two spheres with two points in common, which has
    // the Euler characteristic of a sphere: 2 + 2 - 2.
    std::vector<int> cubes = {4};  // cube x + 3 y + 9 z + 18 w
    for (const int square : {0, 1, 2, 3, 5, 6, 7, 8}) {
        cubes.push_back(square + 9 + 18);
    }
    const LinkReport report =
        check_links(some_cubes(test::kuhn_box<4>({3, 3, 2, 2}, {1, 1, 1, 1}), cubes, 24));
    EXPECT_EQ(report.faulty, 4);
}

TEST(CheckLinks, NoticesALinkThatIsATorus) {
    // The cone over a solid torus in the hyperplane w = 0: its boundary has a torus around the
    // apex. The solid torus: a box of 4 x 4 x 1 cubes without the 2 x 2 in its middle.
    const SimplexMesh<3> ring = some_cubes(test::kuhn_box<3>({4, 4, 1}, {1, 1, 1}),
                                           {0, 1, 2, 3, 4, 7, 8, 11, 12, 13, 14, 15}, 6);
    SimplexMesh<4> cone;
    const Eigen::Index apex = ring.vertex_count();
    cone.positions.setZero(4, apex + 1);
    cone.positions.topLeftCorner(3, apex) = ring.positions;
    cone.positions(3, apex) = 1;
    cone.cells.resize(5, ring.cell_count());
    cone.cells.topRows<4>() = ring.cells;
    cone.cells.row(4).setConstant(static_cast<std::uint32_t>(apex));
    const LinkReport report = check_links(cone);
    EXPECT_EQ(report.faulty, 1);
    EXPECT_EQ(report.first_faulty, apex);
}

}  // namespace
}  // namespace pent::mesher
