#include "pent/viewer/slice.h"

#include "meshes.h"
#include "surfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <support/host_tasks.h>
#include <vector>

namespace pent::viewer {
namespace {

using pent::test::kuhn_box;
using test::is_closed_and_oriented;
using test::jittered_box;
using test::twisted;

// Volume of the section of a 4-simplex at height c: 4 |V| times the B-spline with the heights of
// the five corners as knots (Curry and Schoenberg), as a divided difference. Heights must differ.
double section_volume(double hypervolume, std::array<double, 5> heights, double c) {
    double sum = 0;
    for (int k = 0; k < 5; ++k) {
        double product = 1;
        for (int j = 0; j < 5; ++j) {
            product *= j == k ? 1 : heights[k] - heights[j];
        }
        sum += std::pow(std::max(heights[k] - c, 0.0), 3) / product;
    }
    return 4 * hypervolume * sum;
}

double brute_force_volume(const SimplexMesh<4>& mesh, const FramedHyperplane& plane) {
    const Eigen::VectorXd heights = distances(mesh.positions, plane);
    double volume = 0;
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        std::array<double, 5> h{};
        for (int k = 0; k < 5; ++k) {
            h[k] = heights[mesh.cells(k, cell)];
        }
        volume += section_volume(cell_volume<4>(mesh.positions, mesh.cells, cell), h, 0);
    }
    return volume;
}

// Between two levels of vertices the slice's volume is a cubic in the offset, for which two Gauss
// points are exact.
double integrated_slices(const SimplexMesh<4>& mesh, FramedHyperplane plane) {
    const Boundary<4> boundary = make_boundary(mesh, "mesh");
    plane.offset = 0;
    const Eigen::VectorXd heights = distances(mesh.positions, plane);
    std::vector<double> levels(heights.begin(), heights.end());
    std::sort(levels.begin(), levels.end());
    double sum = 0;
    for (std::size_t i = 1; i < levels.size(); ++i) {
        const double middle = (levels[i] + levels[i - 1]) / 2;
        const double half = (levels[i] - levels[i - 1]) / 2;
        if (half
            < 1e-12) {  // one level but for rounding: the volume between is below the tolerance
            continue;
        }
        for (const double side : {-1, 1}) {
            plane.offset = middle + side * half / std::sqrt(3.0);
            sum += half * enclosed_volume(slice(boundary, mesh.positions, plane));
        }
    }
    return sum;
}

std::vector<FramedHyperplane> awkward_planes() {
    std::vector<FramedHyperplane> planes;
    for (const double offset : {0.0, 1.0, 2.0, 3.0, 0.5, -0.0}) {
        for (const Eigen::Vector4d& normal :
             {Eigen::Vector4d(0, 0, 0, 1), Eigen::Vector4d(0, 0, 0, -1),
              Eigen::Vector4d(1, 0, 0, 0), Eigen::Vector4d(0, -1, 0, 0),
              Eigen::Vector4d(1, 1, 0, 0), Eigen::Vector4d(1, -1, 1, -1),
              Eigen::Vector4d(1, 1, 1, 1)}) {
            planes.push_back(hyperplane_across(normal, offset));
            planes.push_back(hyperplane_across(normal, offset / normal.norm()));
            planes.push_back(hyperplane_across(normal, -offset / normal.norm()));
        }
    }
    return planes;
}

TEST(Slice, OfATesseractIsTheCube) {
    const SimplexMesh<4> mesh = kuhn_box<4>({1, 1, 1, 1}, {2, 3, 5, 1});
    const Surface cube = slice(make_boundary(mesh, "mesh"), mesh.positions, hyperplane_at(0.25));
    EXPECT_TRUE(is_closed_and_oriented(cube));
    EXPECT_NEAR(enclosed_volume(cube), 30, 30 * 1e-14);  // rounding of a few dozen products
    EXPECT_NEAR(area(cube), 62, 62 * 1e-14);
    EXPECT_EQ(bounding_box(cube).min(), Eigen::Vector3d(0, 0, 0));
    EXPECT_EQ(bounding_box(cube).max(), Eigen::Vector3d(2, 3, 5));
}

TEST(Slice, AcrossTheDiagonalOfATesseractIsTheOctahedron) {
    // x + y + z + w = 2 cuts the unit tesseract in a regular octahedron with edge sqrt 2.
    const SimplexMesh<4> mesh = kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 1});
    const Surface octahedron =
        slice(make_boundary(mesh, "mesh"), mesh.positions, hyperplane_across({1, 1, 1, 1}, 1));
    EXPECT_TRUE(is_closed_and_oriented(octahedron));
    EXPECT_NEAR(enclosed_volume(octahedron), 4.0 / 3, 1e-14);
    EXPECT_NEAR(area(octahedron), 4 * std::sqrt(3.0), 1e-14 * 10);
}

TEST(Slice, IsClosedAndOrientedAtEveryAwkwardPlane) {
    const SimplexMesh<4> mesh = kuhn_box<4>({3, 2, 2, 3}, {3, 2, 2, 3});
    const Boundary<4> boundary = make_boundary(mesh, "mesh");
    for (const FramedHyperplane& plane : awkward_planes()) {
        const Surface surface = slice(boundary, mesh.positions, plane);
        EXPECT_TRUE(is_closed_and_oriented(surface)) << plane.frame << " " << plane.offset;
        EXPECT_GE(enclosed_volume(surface), -1e-12);  // rounding of products up to 27
    }
}

TEST(Slice, IsClosedAndOrientedForFlatAndInvertedBodies) {
    SimplexMesh<4> mesh = kuhn_box<4>({2, 2, 2, 2}, {2, 2, 2, 2});
    const Boundary<4> boundary = make_boundary(mesh, "mesh");
    mesh.positions.row(0).array() *= -1;  // inside out
    EXPECT_TRUE(is_closed_and_oriented(slice(boundary, mesh.positions, hyperplane_at(1))));
    EXPECT_NEAR(enclosed_volume(slice(boundary, mesh.positions, hyperplane_at(1.5))), -8,
                8 * 1e-14);
    mesh.positions.row(3).setZero();  // flat, and all of it in the hyperplane
    EXPECT_TRUE(is_closed_and_oriented(slice(boundary, mesh.positions, hyperplane_at(0))));
}

TEST(Slice, OfAnAboveOrBelowBodyIsEmpty) {
    const SimplexMesh<4> mesh = kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 1});
    const Boundary<4> boundary = make_boundary(mesh, "mesh");
    for (const double offset : {-1.0, 0.0, 1.5}) {  // 0: touching from above counts as above
        const Surface none = slice(boundary, mesh.positions, hyperplane_at(offset));
        EXPECT_EQ(none.vertex_count(), 0);
        EXPECT_EQ(none.triangle_count(), 0);
        EXPECT_EQ(enclosed_volume(none), 0);
        EXPECT_TRUE(bounding_box(none).isEmpty());
    }
}

TEST(Slice, VolumeEqualsTheSumOverSlicedPentachora) {
    SimplexMesh<4> mesh = jittered_box({3, 2, 2, 3}, 7);
    mesh.positions = twisted(mesh.positions, 0.4);
    const Boundary<4> boundary = make_boundary(mesh, "mesh");
    for (const double offset : {0.05, 0.3, 0.61, 0.9, 1.2}) {
        for (const FramedHyperplane& plane :
             {hyperplane_at(offset), hyperplane_across({0.3, -0.5, 0.2, 0.7}, offset / 2)}) {
            const double expected = brute_force_volume(mesh, plane);
            // The divided differences of the brute force cancel about six digits.
            EXPECT_NEAR(enclosed_volume(slice(boundary, mesh.positions, plane)), expected, 1e-8);
        }
    }
}

TEST(Slice, VolumesIntegrateToTheHypervolume) {
    SimplexMesh<4> mesh = jittered_box({2, 2, 1, 2}, 3);
    mesh.positions = twisted(mesh.positions, 0.3);
    const double expected = total_volume(mesh);
    EXPECT_NEAR(integrated_slices(mesh, hyperplane_at(0)), expected, 1e-12);
    const PlaneRotation turns[] = {{0, 3, 0.4}, {1, 2, -1.1}, {3, 1, 0.6}};
    EXPECT_NEAR(integrated_slices(mesh, hyperplane_at(0, turns)), expected, 1e-12);
}

TEST(Slice, AfterRotationEqualsTheRotatedBodySlicedPlainly) {
    const SimplexMesh<4> mesh = jittered_box({2, 2, 2, 2}, 5);
    const Boundary<4> boundary = make_boundary(mesh, "mesh");
    const PlaneRotation turns[] = {{0, 3, 0.5}, {2, 3, -0.3}};
    const Positions<4> turned = rotation_matrix(turns) * mesh.positions;
    const Surface a = slice(boundary, mesh.positions, hyperplane_at(0.4, turns));
    const Surface b = slice(boundary, turned, hyperplane_at(0.4));
    ASSERT_EQ(a.triangles, b.triangles);
    // Rounding of the rotation, magnified by edges that cross at a slant.
    EXPECT_LT((a.positions - b.positions).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(Slice, VerticesLieOnTheirEdgesAndInTheHyperplane) {
    const SimplexMesh<4> mesh = jittered_box({2, 2, 2, 2}, 11);
    const FramedHyperplane plane = hyperplane_across({0.2, 0.1, -0.4, 1}, 0.3);
    const Surface surface = slice(make_boundary(mesh, "mesh"), mesh.positions, plane);
    for (int axis = 0; axis < 4; ++axis) {
        const Eigen::VectorXd seen =
            interpolate(surface, (plane.frame.row(axis) * mesh.positions).transpose());
        for (Eigen::Index v = 0; v < surface.vertex_count(); ++v) {
            const double expected = axis < 3 ? surface.positions(axis, v) : plane.offset;
            EXPECT_NEAR(seen[v], expected, 1e-14);
        }
    }
}

TEST(Slice, IsTheSameToTheBitForAnyNumberOfThreads) {
    const SimplexMesh<4> mesh = jittered_box({6, 6, 6, 6}, 13);
    const Boundary<4> boundary = make_boundary(mesh, "mesh");
    const Surface reference = slice(boundary, mesh.positions, hyperplane_at(0.31));
    for (const int threads : {1, 2, 3}) {
        const Surface surface = Workers(pent::test::host_tasks(threads)).run([&] {
            return slice(boundary, mesh.positions, hyperplane_at(0.31));
        });
        EXPECT_EQ(surface.positions, reference.positions);
        EXPECT_EQ(surface.triangles, reference.triangles);
        EXPECT_EQ(surface.facets, reference.facets);
    }
}

TEST(MergeCoincident, LeavesNoZeroAreaAndStaysClosedAtALayer) {
    const SimplexMesh<4> mesh = kuhn_box<4>({2, 2, 2, 2}, {2, 2, 2, 2});
    const Boundary<4> boundary = make_boundary(mesh, "mesh");
    for (const double layer : {1.0, 2.0}) {
        const Surface raw = slice(boundary, mesh.positions, hyperplane_at(layer));
        const Surface merged = merge_coincident(raw);
        EXPECT_EQ(test::smallest_area(raw), 0);
        EXPECT_GT(test::smallest_area(merged), 0.4);  // halves of unit squares
        EXPECT_EQ(merged.vertex_count(), 26);
        EXPECT_EQ(merged.triangle_count(), 48);
        EXPECT_TRUE(is_closed_and_oriented(merged));
        EXPECT_NEAR(enclosed_volume(merged), 8, 8 * 1e-14);
    }
}

TEST(MergeCoincident, KeepsTwoTrianglesAtEveryEdgeAtEveryAwkwardPlane) {
    const SimplexMesh<4> mesh = kuhn_box<4>({3, 2, 2, 3}, {3, 2, 2, 3});
    const Boundary<4> boundary = make_boundary(mesh, "mesh");
    for (const FramedHyperplane& plane : awkward_planes()) {
        const Surface raw = slice(boundary, mesh.positions, plane);
        const Surface merged = merge_coincident(raw);
        EXPECT_TRUE(is_closed_and_oriented(merged));
        EXPECT_LE(merged.triangle_count(), raw.triangle_count());
        EXPECT_NEAR(enclosed_volume(merged), enclosed_volume(raw), 1e-12);
    }
}

TEST(MergeCoincident, KeepsPinchedEdgesApart) {
    // Integer coordinates collapsed to a few values make planes that pinch the body in many places.
    std::mt19937 random(17);
    std::uniform_int_distribution<int> coordinate(-1, 1);
    SimplexMesh<4> mesh = kuhn_box<4>({2, 2, 2, 2}, {2, 2, 2, 2});
    const Boundary<4> boundary = make_boundary(mesh, "mesh");
    for (int repeat = 0; repeat < 50; ++repeat) {
        for (double& x : mesh.positions.reshaped()) {
            x = coordinate(random);
        }
        const Surface raw = slice(boundary, mesh.positions, hyperplane_at(0));
        ASSERT_TRUE(is_closed_and_oriented(raw));
        ASSERT_TRUE(is_closed_and_oriented(merge_coincident(raw)));
    }
}

TEST(Skin, OfABoxIsItsSurface) {
    const SimplexMesh<3> mesh = kuhn_box<3>({2, 3, 4}, {2, 3, 4});
    const Surface surface = skin(make_boundary(mesh, "mesh"), mesh.positions);
    EXPECT_TRUE(is_closed_and_oriented(surface));
    EXPECT_NEAR(enclosed_volume(surface), 24, 24 * 1e-14);
    EXPECT_NEAR(area(surface), 52, 52 * 1e-14);
    EXPECT_EQ(surface.vertex_count(), 60 - 6);  // all grid points but those inside
}

}  // namespace
}  // namespace pent::viewer
