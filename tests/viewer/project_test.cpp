#include "pent/viewer/project.h"

#include "meshes.h"
#include "surfaces.h"

#include <pent/error.h>
#include <pent/viewer/attributes.h>
#include <pent/viewer/slice.h>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <utility>

namespace pent::viewer {
namespace {

using pent::test::kuhn_box;
using test::is_closed_and_oriented;

// Whether every edge is run along as often one way as the other.
bool is_balanced(const Surface& surface) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
    for (const auto& triangle : surface.triangles.colwise()) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = triangle[k];
            const std::uint32_t b = triangle[(k + 1) % 3];
            balance[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
        }
    }
    return std::all_of(balance.begin(), balance.end(), [](const auto& e) { return e.second == 0; });
}

TEST(Outline, OfABoxAlongWIsItsBaseBox) {
    const SimplexMesh<4> mesh = kuhn_box<4>({2, 2, 2, 3}, {2, 3, 4, 5});
    const Surface surface = outline(make_boundary(mesh, "box"), mesh.positions, {});
    EXPECT_TRUE(is_closed_and_oriented(surface));
    EXPECT_NEAR(enclosed_volume(surface), 24, 24 * 1e-14);
    EXPECT_NEAR(area(surface), 52, 52 * 1e-14);
}

TEST(Outline, OfATesseractAlongItsDiagonalIsTheRhombicDodecahedron) {
    // Its volume is 2 in the units of the tesseract's edge: the sum over the four pairs of cells of
    // |cos| = 1/2 each.
    const SimplexMesh<4> mesh = kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 1});
    const Projection diagonal{.film = hyperplane_across({1, 1, 1, 1}, 1)};
    const Surface surface = outline(make_boundary(mesh, "box"), mesh.positions, diagonal);
    EXPECT_TRUE(is_closed_and_oriented(surface));
    EXPECT_NEAR(enclosed_volume(surface), 2, 1e-13);
}

TEST(Outline, VolumeIsThatOfAllTetrahedraSeenFromTheFront) {
    // Each tetrahedron counts with its volume times the cosine it is seen under; the images of all
    // that face away add up to the same.
    SimplexMesh<4> mesh = test::jittered_box({3, 3, 3, 3}, 31);
    mesh.positions = test::twisted(mesh.positions, 0.4);
    const Boundary<4> boundary = make_boundary(mesh, "box");
    const Projection oblique{.film = hyperplane_across({0.3, -0.2, 0.5, 1}, 0)};
    const Positions<3> images = project(mesh.positions, oblique);
    double front = 0;
    for (const auto& tet : boundary.facets.colwise()) {
        Eigen::Matrix3d edges;
        for (int k = 0; k < 3; ++k) {
            edges.col(k) = images.col(tet[k + 1]) - images.col(tet[0]);
        }
        front += std::max(0.0, -edges.determinant() / 6);
    }
    const Surface surface = outline(boundary, mesh.positions, oblique);
    EXPECT_TRUE(is_balanced(surface));
    EXPECT_NEAR(enclosed_volume(surface), front, 1e-12);
}

TEST(Project, LeavesPointsOfTheFilmWhereTheyAre) {
    SimplexMesh<4> mesh = test::jittered_box({2, 2, 2, 2}, 32);
    const FramedHyperplane film = hyperplane_at(0.5);
    mesh.positions.row(3).setConstant(0.5);
    Projection projection{.film = film, .center = {0.1, 0.2, 0.3}, .eye_distance = 2.0};
    EXPECT_LT((project(mesh.positions, projection) - mesh.positions.topRows<3>()).norm(), 1e-14);
}

TEST(Project, ShrinksWhatIsFurtherFromTheEye) {
    // The eye is 2 over the film; a point 2 below it is seen at half its distance from the center.
    const Eigen::Vector4d point(1.5, 0, 0, -2);
    const Projection projection{.film = {}, .center = {0.5, 0, 0}, .eye_distance = 2.0};
    EXPECT_NEAR(project(point, projection)(0), 1.0, 1e-15);
}

TEST(Project, RefusesPointsBehindTheEye) {
    const Projection projection{.film = {}, .center = {0, 0, 0}, .eye_distance = 2.0};
    EXPECT_THROW((void)project(Eigen::Vector4d(0, 0, 0, 2), projection), Error);
    EXPECT_THROW((void)project(Eigen::Vector4d(0, 0, 0, 3), projection), Error);
}

TEST(Outline, OfAPerspectiveAlongWContainsTheSlice) {
    const SimplexMesh<4> mesh = kuhn_box<4>({2, 2, 2, 2}, {1, 1, 1, 1});
    const Projection projection{
        .film = hyperplane_at(0.5), .center = {0.5, 0.5, 0.5}, .eye_distance = 4.0};
    const Surface surface = outline(make_boundary(mesh, "box"), mesh.positions, projection);
    EXPECT_TRUE(is_closed_and_oriented(surface));
    // The near side, at w = 1, is seen 4 / 3.5 times as large, and hides all else.
    EXPECT_NEAR(enclosed_volume(surface), std::pow(4 / 3.5, 3), 1e-13);
}

TEST(MakeProjection, KeepsTheEyeOutsideTheBodies) {
    Frame<4> frame;
    frame.positions = test::jittered_box({1, 1, 1, 1}, 1).positions;
    const Projection projection =
        make_projection({.is_perspective = true}, {}, std::span(&frame, 1));
    EXPECT_NO_THROW((void)project(frame.positions, projection));
    EXPECT_THROW((void)make_projection({.is_perspective = true, .eye_distance = -1.0}, {},
                                       std::span(&frame, 1)),
                 Error);
}

TEST(CornerNormals, OfABareSurfaceAreTheSidesOfABox) {
    const SimplexMesh<4> mesh = kuhn_box<4>({2, 2, 2, 2}, {1, 1, 1, 1});
    const Surface surface = outline(make_boundary(mesh, "box"), mesh.positions, {});
    const Positions<3> normals = corner_normals(surface, 1.0);
    for (const auto& normal : normals.colwise()) {
        EXPECT_NEAR(normal.cwiseAbs().maxCoeff(), 1, 1e-14);  // along an axis
    }
}

}  // namespace
}  // namespace pent::viewer
