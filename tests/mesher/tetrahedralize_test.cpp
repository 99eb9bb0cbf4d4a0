#include "shapes.h"
#include "support/messages.h"

#include <pent/error.h>
#include <pent/facets.h>
#include <pent/mesher/orient.h>
#include <pent/mesher/tetrahedralize.h>

#include <gtest/gtest.h>

namespace pent::mesher {
namespace {

TetrahedraOptions options() {
    TetrahedraOptions result;
    result.generator = Generator::TetGen;
    result.worker = PENT_TETGEN_WORKER;
    return result;
}

std::string message_for(const Surface& surface, const TetrahedraOptions& wanted) {
    return test::error_of([&] { static_cast<void>(tetrahedralize(surface, wanted)); });
}

TEST(Tetrahedralize, FillsAModelAndKeepsItsSurface) {
    const Surface octopus =
        orient(read_surface(std::string(PENT_MODELS) + "/octopus_5246f.obj").surface).surface;
    const Tetrahedra tetrahedra = tetrahedralize(octopus, options());
    const SimplexMesh<3>& mesh = tetrahedra.mesh;
    EXPECT_NO_THROW(validate(mesh, "octopus"));
    EXPECT_EQ(mesh.positions.leftCols(octopus.point_count()), octopus.points);
    const auto match = match_facets<3>(mesh.cells, mesh.vertex_count());
    EXPECT_TRUE(match.is_conforming());
    EXPECT_EQ(match.boundary.cols(), octopus.triangle_count());
    // Two sums of about 10^4 terms of one sign, each exact to a few units in the last place.
    EXPECT_LT(tetrahedra.volume_error, 1e-12);
}

TEST(Tetrahedralize, LeavesCavitiesEmptyAndFillsEveryComponent) {
    const Surface hollow = test::join(test::box_surface({0, 0, 0}, {3, 3, 3}),
                                      test::box_surface({1, 1, 1}, {2, 2, 2}));
    EXPECT_NEAR(total_volume(tetrahedralize(orient(hollow).surface, options()).mesh), 26, 1e-12);
    const Surface apart = test::join(test::box_surface({0, 0, 0}, {1, 1, 1}),
                                     test::box_surface({3, 0, 0}, {3.05, 0.05, 0.05}));
    EXPECT_NEAR(total_volume(tetrahedralize(apart, options()).mesh), 1.000125, 1e-12);
}

TEST(Tetrahedralize, AimsAtTheEdgeLength) {
    TetrahedraOptions fine = options();
    fine.edge_length = 0.2;
    fine.keep_surface = false;  // the twelve triangles would keep all points away
    const Tetrahedra tetrahedra = tetrahedralize(test::box_surface({0, 0, 0}, {1, 1, 1}), fine);
    // Every tetrahedron is at most as large as the regular one, 0.2^3 / (6 sqrt 2) = 0.000943.
    EXPECT_GE(tetrahedra.mesh.cell_count(), 1061);
}

TEST(Tetrahedralize, TurnsEveryFailureOfTheWorkerIntoAnError) {
    const Surface box = test::box_surface({0, 0, 0}, {1, 1, 1});
    Surface open = box;
    open.triangles = open.triangles.leftCols<11>().eval();
    EXPECT_NE(message_for(open, options()), "");
    EXPECT_NE(message_for(test::box_surface({0, 0, 0}, {1, 1, 0}), options()), "");
    EXPECT_NE(
        message_for(test::join(box, test::box_surface({0.5, 0.5, 0.5}, {2, 2, 2})), options()), "");
    Surface empty;
    empty.points.resize(3, 1);
    empty.points.setZero();
    empty.triangles.resize(3, 0);
    EXPECT_NE(message_for(empty, options()), "");
    Surface nan = box;
    nan.points(0, 0) = std::nan("");
    EXPECT_NE(message_for(nan, options()), "");
}

TEST(Tetrahedralize, NamesAMissingOrWrongWorker) {
    const Surface box = test::box_surface({0, 0, 0}, {1, 1, 1});
    TetrahedraOptions wrong = options();
    wrong.worker = "/no/such/worker";
    test::expect_contains(message_for(box, wrong), {"/no/such/worker"});
    wrong.worker = "/bin/true";
    test::expect_contains(message_for(box, wrong), {"answer cannot be read"});
    wrong.worker.clear();  // the test program has no worker beside it
    test::expect_contains(message_for(box, wrong), {"pent-tetgen: not found"});
}

TEST(Tetrahedralize, EndsAWorkerThatPassesItsLimits) {
    const Surface box = test::box_surface({0, 0, 0}, {1, 1, 1});
    TetrahedraOptions greedy = options();
    greedy.edge_length = 0.001;  // would be 10^10 tetrahedra
    greedy.keep_surface = false;
    greedy.max_added_points = 1'000'000'000;
    greedy.limits.seconds = 1;
    test::expect_contains(message_for(box, greedy), {"ended after 1 s"});
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    greedy.limits.seconds = 60;
    greedy.limits.memory_mib = 64;
    test::expect_contains(message_for(box, greedy), {"64 MiB of memory"});
#endif
}

TEST(Tetrahedralize, RefusesOptionsOutOfRange) {
    const Surface box = test::box_surface({0, 0, 0}, {1, 1, 1});
    TetrahedraOptions wrong = options();
    wrong.radius_edge_ratio = 0.9;
    test::expect_contains(message_for(box, wrong), {"radius-edge"});
    wrong = options();
    wrong.edge_length = -1;
    test::expect_contains(message_for(box, wrong), {"edge length"});
}

TEST(TetrahedralizeByMesh3, FillsEveryBodyAndLeavesCavitiesEmpty) {
    TetrahedraOptions mesh3;
    mesh3.generator = Generator::Mesh3;
    mesh3.edge_length = 0.5;
    const Surface hollow = test::join(test::box_surface({0, 0, 0}, {3, 3, 3}),
                                      test::box_surface({1, 1, 1}, {2, 2, 2}));
    const Surface both = test::join(hollow, test::box_surface({4, 0, 0}, {4.3, 0.3, 0.3}));
    const Tetrahedra tetrahedra = tetrahedralize(orient(both).surface, mesh3);
    // Sharp edges are kept, so that boxes come out to rounding of their flat sides.
    EXPECT_NEAR(total_volume(tetrahedra.mesh), 26.027, 1e-6);
    EXPECT_EQ(tetrahedra.generator, "CGAL Mesh_3");
}

TEST(TetrahedralizeByMesh3, EndsAtItsLimit) {
    const Surface box = test::box_surface({0, 0, 0}, {1, 1, 1});
    TetrahedraOptions greedy;
    greedy.generator = Generator::Mesh3;
    greedy.edge_length = 0.002;  // would be 10^9 tetrahedra
    greedy.limits.seconds = 1;
    test::expect_contains(message_for(box, greedy), {"Mesh_3 was ended after 1 s"});
}

TEST(TetrahedralizeAuto, FallsBackToMesh3AndSaysWhy) {
    TetrahedraOptions broken;
    broken.worker = "/bin/false";
    const Tetrahedra tetrahedra = tetrahedralize(test::box_surface({0, 0, 0}, {1, 1, 1}), broken);
    EXPECT_EQ(tetrahedra.generator, "CGAL Mesh_3");
    test::expect_contains(tetrahedra.failures, {"TetGen", "code 1"});
}

}  // namespace
}  // namespace pent::mesher
