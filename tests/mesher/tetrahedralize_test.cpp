#include "../../mesher/tetgen_worker/protocol.h"
#include "shapes.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/error.h>
#include <pent/facets.h>
#include <pent/mesher/orient.h>
#include <pent/mesher/tetrahedralize.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sys/resource.h>
#include <sys/wait.h>

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

// Bodies in cavities of bodies, of which some have no side outside; with the surface's triangles as
// they are, and cut.
TEST(Tetrahedralize, FillsBodiesWithinCavitiesAndNothingElse) {
    Surface nested = test::box_surface({0, 0, 0}, {20, 10, 10});
    double volume = 2000;
    for (const double x : {0.0, 10.0}) {
        for (int depth = 1; depth <= 4; ++depth) {
            const Eigen::Vector3d low(x + depth, depth, depth);
            const double size = 10.0 - 2 * depth;
            nested = test::join(nested, test::box_surface(low, low.array() + size));
            volume += (depth % 2 == 1 ? -1 : 1) * size * size * size;
        }
    }
    for (const bool keep_surface : {true, false}) {
        TetrahedraOptions wanted = options();
        wanted.keep_surface = keep_surface;
        const SimplexMesh<3> mesh = tetrahedralize(orient(nested).surface, wanted).mesh;
        EXPECT_NEAR(total_volume(mesh), volume, 1e-9);
        for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
            Eigen::Vector3d middle = Eigen::Vector3d::Zero();
            for (const std::uint32_t corner : mesh.cells.col(cell)) {
                middle += mesh.positions.col(corner) / 4;
            }
            middle[0] -= middle[0] > 10 ? 10 : 0;
            const double depth = std::min(middle.minCoeff(), 10 - middle.maxCoeff());
            EXPECT_EQ(static_cast<int>(depth) % 2, 0) << depth;
        }
    }
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

// A worker in TetGen's place that does what this shell script does.
TetrahedraOptions with_worker(const test::TempFolder& folder, const std::string& script) {
    TetrahedraOptions result = options();
    result.worker = folder / "worker";
    test::write_file(folder / "worker", "#!/bin/sh\n" + script);
    std::filesystem::permissions(folder / "worker", std::filesystem::perms::owner_all);
    return result;
}

TEST(Tetrahedralize, ExplainsEveryWayAWorkerMayEnd) {
    const test::TempFolder folder;
    const Surface box = test::box_surface({0, 0, 0}, {1, 1, 1});
    using namespace tetgen;
    for (const auto& [code, words] : {std::pair<int, std::string>(kOutOfMemory, "MiB of memory"),
                                      {kTetgenThrew + 1, "MiB of memory"},
                                      {kTetgenThrew + 2, "an internal error"},
                                      {kTetgenThrew + 3, "the surface intersects itself"},
                                      {kTetgenThrew + 4, "too small for double precision"},
                                      {kTetgenThrew + 5, "too close to each other"},
                                      {kTetgenThrew + 10, "refused the surface"},
                                      {kCannotWrite, "cannot write its answer"},
                                      {77, "failed with code 77"}}) {
        const TetrahedraOptions worker = with_worker(folder, "exit " + std::to_string(code) + "\n");
        test::expect_contains(message_for(box, worker), {"TetGen pq", words});
    }
    test::expect_contains(message_for(box, with_worker(folder, "kill -11 $$\n")),
                          {"TetGen pq", "crashed (signal 11)"});
}

// An answer of these tetrahedra, all in one region, for a worker to hand out.
TetrahedraOptions with_answer(const test::TempFolder& folder,
                              const Positions<3>& points,
                              const Simplices<4>& tets) {
    const tetgen::Header header{tetgen::kAnswerTag, static_cast<std::uint32_t>(points.cols()),
                                static_cast<std::uint32_t>(tets.cols())};
    const std::vector<double> regions(static_cast<std::size_t>(tets.cols()), 1.0);
    std::ofstream file(folder / "answer", std::ios::binary);
    const auto put = [&](const void* data, std::size_t bytes) {
        file.write(static_cast<const char*>(data), static_cast<std::streamsize>(bytes));
    };
    put(&header, sizeof header);
    put(points.data(), sizeof(double) * static_cast<std::size_t>(points.size()));
    put(tets.data(), sizeof(std::uint32_t) * static_cast<std::size_t>(tets.size()));
    put(regions.data(), sizeof(double) * regions.size());
    return with_worker(folder, "cat " + (folder / "answer").string() + "\n");
}

TEST(Tetrahedralize, ProvesWhatTheWorkerAnswers) {
    const test::TempFolder folder;
    Surface corner;  // of the unit cube
    corner.points.resize(3, 4);
    corner.points << Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity();
    corner.triangles.resize(3, 4);
    corner.triangles << 0, 0, 1, 0, 2, 1, 2, 3, 1, 3, 3, 2;
    Simplices<4> one(4, 1);
    one << 0, 2, 1, 3;  // the wrong way around
    const Tetrahedra turned = tetrahedralize(corner, with_answer(folder, corner.points, one));
    EXPECT_DOUBLE_EQ(total_volume(turned.mesh), 1.0 / 6);

    Positions<3> halves(3, 7);           // half the corner, and its mirror image behind the origin
    halves << 0, 0.5, 0, 0, -0.5, 0, 0,  //
        0, 0, 1, 0, 0, -1, 0,            //
        0, 0, 0, 1, 0, 0, -1;
    Simplices<4> two(4, 2);
    two << 0, 0, 1, 1, 2, 2, 3, 3;
    test::expect_contains(message_for(corner, with_answer(folder, halves.leftCols<4>(), two)),
                          {"TetGen pq", "is not sound"});
    two.col(1) << 0, 4, 5, 6;
    test::expect_contains(message_for(corner, with_answer(folder, halves, two)),
                          {"TetGen pq", "touches itself at 1 point"});
}

TEST(Tetrahedralize, SaysWhenItsFilesCannotBeWrittenOrItsWorkerNotBeWaitedFor) {
    const Surface box = test::box_surface({0, 0, 0}, {1, 1, 1});
    rlimit before = {};
    ::getrlimit(RLIMIT_NOFILE, &before);
    const rlimit none = {0, before.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &none);
    const std::string no_file = message_for(box, options());
    ::setrlimit(RLIMIT_NOFILE, &before);
    test::expect_contains(no_file, {"cannot make a temporary file", "Too many open files"});

    ::getrlimit(RLIMIT_FSIZE, &before);
    const auto on_size = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small = {100, before.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &small);
    const std::string no_room = message_for(box, options());
    ::setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, on_size);
    test::expect_contains(no_room, {"cannot write a temporary file", "make room"});

    const auto on_child = std::signal(SIGCHLD, SIG_IGN);  // nobody then keeps how a child ended
    const std::string no_child = message_for(box, options());
    std::signal(SIGCHLD, on_child);
    test::expect_contains(no_child, {"pent-tetgen: cannot be waited for: No child processes"});
}

// The exit code of the worker itself.
int worker_code(const std::string& arguments) {
    const std::string line = PENT_TETGEN_WORKER " " + arguments + " 2>/dev/null";
    return WEXITSTATUS(std::system(line.c_str()));  // NOLINT(cert-env33-c)
}

TEST(TetgenWorker, NamesWhatItCannotWorkWithByItsExitCode) {
    const test::TempFolder folder;
    EXPECT_EQ(worker_code(""), tetgen::kBadArguments);
    EXPECT_EQ(worker_code("pq 1000 10 >&-"), tetgen::kCannotWrite);
    const auto request = [&](std::uint32_t points, std::uint32_t triangles, std::size_t bytes) {
        const tetgen::Header header{tetgen::kRequestTag, points, triangles};
        std::string text(reinterpret_cast<const char*>(&header), sizeof header);
        text.resize(sizeof header + bytes, '\0');
        test::write_file(folder / "request", text);
        return worker_code("pq 1000 10 <" + (folder / "request").string() + " >/dev/null");
    };
    EXPECT_EQ(worker_code("pq 1000 10 </dev/null >/dev/null"), tetgen::kBadRequest);
    EXPECT_EQ(request(4, 0, 90), tetgen::kBadRequest);           // points cut off
    EXPECT_EQ(request(4, 4, 4 * 24 + 40), tetgen::kBadRequest);  // triangles cut off
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    EXPECT_EQ(request(2'000'000'000, 0, 0), tetgen::kOutOfMemory);
#endif
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
