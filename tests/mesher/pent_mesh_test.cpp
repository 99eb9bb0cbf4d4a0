#include "apps/run_program.h"
#include "shapes.h"
#include "support/kuhn_box.h"
#include "support/messages.h"

#include <pent/pent_file.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace pent {
namespace {

using test::Outcome;
using test::run_program;

const std::string kModels = PENT_MODELS;

TEST(PentMesh, MakesTheSameBytesAtAnyNumberOfThreads) {
    const test::TempFolder folder;
    std::string first;
    for (const char* threads : {"1", "2", "3"}) {
        const std::string out = (folder / threads).string() + ".pent";
        const Outcome outcome = run_program("pent-mesh " + kModels + "/octopus_5246f.obj -o " + out
                                            + " --layers 3 --threads " + threads);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        const std::string bytes = test::text_of(out);
        first = first.empty() ? bytes : first;
        EXPECT_TRUE(bytes == first) << threads << " threads";
    }
}

TEST(PentMesh, SaysWhatItMadeAndWhere) {
    const test::TempFolder folder;
    const std::string out = (folder / "cube.pent").string();
    const Outcome outcome = run_program("pent-mesh " + kModels + "/dirty/d_cube.off -o " + out
                                        + " --quality --json " + (folder / "report.json").string()
                                        + " --histogram " + (folder / "histogram.svg").string());
    EXPECT_EQ(outcome.exit_code, 0);
    for (const char* part : {"24 pentachora", "0.2 m^4", "worst cells", "finished: "}) {
        EXPECT_NE(outcome.out.find(part), std::string::npos) << part;
    }
    EXPECT_NE(test::text_of(folder / "report.json").find("\"verdict\": \"finished\""),
              std::string::npos);
    EXPECT_EQ(test::text_of(folder / "histogram.svg").rfind("<svg", 0), 0U);
    EXPECT_EQ(run_program("pent-check " + out).exit_code, 0);
}

TEST(PentMesh, SaysWhichCellsItCutAndLeftOut) {
    const test::TempFolder folder;
    // A tetrahedron with middles of its edges, a prism at its side, a triangle.
    test::write_file(folder / "mixed.mesh",
                     "MeshVersionFormatted 2\nDimension 3\nVertices 7\n0 0 0 0\n1 0 0 0\n0 1 0 0\n"
                     "0 0 1 0\n0 0 -1 0\n1 0 -1 0\n0 1 -1 0\nTetrahedraP2 1\n"
                     "1 2 3 4 1 1 1 1 1 1 0\nPrisms 1\n5 6 7 1 2 3 0\nTriangles 1\n5 7 6 0\nEnd\n");
    const Outcome outcome = run_program("pent-mesh " + (folder / "mixed.mesh").string()
                                        + " --thickness 1 -o " + (folder / "mixed.pent").string()
                                        + " --json " + (folder / "report.json").string());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    test::expect_contains(outcome.out,
                          {"cut        1 prism into 3 tetrahedra\n",
                           "straight   1 cell of higher order, by their corners alone\n",
                           "left out   1 triangle: of fewer than three dimensions\n"});
    test::expect_contains(
        test::text_of(folder / "report.json"),
        {R"("cut": "1 prism into 3 tetrahedra")", R"("left_out": "1 triangle")", R"("curved": 1)"});
}

TEST(PentMesh, ExtrudesAFlatMeshIn3D) {
    const test::TempFolder folder;
    test::write_file(folder / "flat.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    const std::string out = (folder / "flat.pent").string();
    EXPECT_EQ(
        run_program("pent-mesh " + (folder / "flat.obj").string() + " --dim 3 -o " + out).exit_code,
        0);
    EXPECT_NE(run_program("pent-check " + out).out.find("dimension 3"), std::string::npos);
}

TEST(PentMesh, FindsItsWorkerWhereItIsInstalled) {
    namespace fs = std::filesystem;
    const test::TempFolder folder;
    fs::create_directories(folder / "bin");
    fs::create_directories(folder / "libexec/pent");
    fs::copy_file(PENT_BIN "/pent-mesh", folder / "bin/pent-mesh");
    const auto generator = [&] {
        const std::string line = (folder / "bin/pent-mesh").string() + " " + kModels
                                 + "/dirty/d_cube.off --quiet -o " + (folder / "cube.pent").string()
                                 + " --json " + (folder / "report.json").string();
        EXPECT_EQ(std::system(line.c_str()), 0);  // NOLINT(cert-env33-c)
        return test::text_of(folder / "report.json");
    };
    test::expect_contains(generator(), {R"("generator": "CGAL Mesh_3")", "pent-tetgen: not found"});
    fs::copy_file(PENT_BIN "/pent-tetgen", folder / "libexec/pent/pent-tetgen");
    test::expect_contains(generator(), {R"("generator": "TetGen )"});
}

TEST(PentMesh, LeavesNothingBehindWhenItRefuses) {
    const test::TempFolder folder;
    const std::string out = (folder / "out.pent").string();
    const Outcome outcome =
        run_program("pent-mesh " + kModels + "/dirty/d_open.off --repair none -o " + out);
    EXPECT_EQ(outcome.exit_code, 1);
    test::expect_one_error_line(outcome, "pent-mesh");
    EXPECT_NE(outcome.err.find("3 border edges"), std::string::npos);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(PentMesh, GivesUpAfterItsTimeLimit) {
    const test::TempFolder folder;
    // In the foreground: else the signal comes twice, and the second ends the program at once.
    const Outcome outcome = run_program(
        "pent-mesh " + kModels + "/octopus_5246f.obj --edge-length 0.005 --time-limit 1 -o "
        + (folder / "out.pent").string() + " --json " + (folder / "report.json").string());
    EXPECT_EQ(outcome.exit_code, 1);
    test::expect_one_error_line(outcome, "pent-mesh");
    EXPECT_NE(outcome.err.find("--time-limit"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder / "out.pent"));
    test::expect_contains(test::text_of(folder / "report.json"),
                          {R"("verdict": "refused")", "not done after 1 s", R"("seconds": 1)"});
}

TEST(PentMesh, StopsAtCtrlCWithAVerdictOfItsOwn) {
    const test::TempFolder folder;
    // In the foreground: else the signal comes twice, and the second ends the program at once.
    const Outcome outcome = run_program(
        "pent-mesh " + kModels + "/octopus_5246f.obj --edge-length 0.005 -o "
            + (folder / "out.pent").string() + " --json " + (folder / "report.json").string(),
        "timeout --foreground --preserve-status --signal=INT 0.5");
    EXPECT_EQ(outcome.exit_code, 3);
    test::expect_one_error_line(outcome, "pent-mesh");
    test::expect_contains(outcome.err, {"stopped as asked", "no mesh was written"});
    test::expect_contains(test::text_of(folder / "report.json"), {R"("verdict": "stopped")"});
    EXPECT_FALSE(std::filesystem::exists(folder / "out.pent"));
}

TEST(PentMesh, SaysWhatItMended) {
    const test::TempFolder folder;
    const std::string out = " --layers 1 -o " + (folder / "out.pent").string();
    test::expect_contains(run_program("pent-mesh " + kModels + "/dirty/d_open.off" + out).out,
                          {"found      ", "3 border edges", "mended     lightly"});
    test::expect_contains(run_program("pent-mesh " + kModels + "/dirty/d_flipped.off" + out).out,
                          {"corrected  ", "1 triangles turned over"});
}

TEST(PentMesh, TakesShapesDirectionsAndLimits) {
    const test::TempFolder folder;
    const std::string out = (folder / "out.pent").string();
    // A ball of radius 2 from a surface, of 20 triangles: an icosahedron, leaning over by x.
    const Outcome ball = run_program(
        "pent-mesh --sphere 1 --size 2 --extrude 1,0,0,3 --layers 1"
        " --memory-limit 20000 -o "
        + out);
    ASSERT_EQ(ball.exit_code, 0) << ball.err;
    const SimplexMesh<4> mesh = read_mesh<4>(out).mesh;
    const double edge = 2 / std::sin(2 * std::numbers::pi / 5);  // of the icosahedron
    EXPECT_NEAR(total_volume(mesh), 3 * 5 * (3 + std::sqrt(5.0)) / 12 * std::pow(edge, 3), 1e-9);
}

TEST(PentMesh, SaysWhatToDoWhenMemoryRunsOut) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers reserve terabytes";
#endif
    const test::TempFolder folder;
    const Outcome outcome =
        run_program("pent-mesh --box 200,200,200,20 -o " + (folder / "out.pent").string(),
                    "ulimit -v 1000000;");
    EXPECT_EQ(outcome.exit_code, 1);
    test::expect_one_error_line(outcome, "pent-mesh");
    test::expect_contains(outcome.err, {"out of memory", "ask for fewer cells"});
}

TEST(PentMesh, WantsExactlyOneInput) {
    EXPECT_EQ(run_program("pent-mesh -o out.pent").exit_code, 2);
    EXPECT_EQ(run_program("pent-mesh a.obj --ball 4 -o out.pent").exit_code, 2);
    EXPECT_EQ(run_program("pent-mesh a.obj --thickness 1 --extrude 0,0,0,1 -o o.pent").exit_code,
              2);
}

TEST(PentCheck, ProvesTheTables) {
    const Outcome outcome = run_program("pent-check");
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_NE(outcome.out.find("finished: all proved"), std::string::npos);
}

TEST(PentCheck, SaysWhenItsReportCannotBeWritten) {
    const Outcome sound = run_program("pent-check --json /no/such/folder/report.json");
    EXPECT_EQ(sound.exit_code, 1);
    test::expect_one_error_line(sound, "pent-check");
    test::expect_contains(sound.err, {"/no/such/folder/report.json", "cannot be written"});
    // What is wrong with the input is more to the point.
    const Outcome missing = run_program("pent-check none.pent --json /no/such/folder/report.json");
    EXPECT_EQ(missing.exit_code, 1);
    test::expect_one_error_line(missing, "pent-check");
    test::expect_contains(missing.err, {"none.pent"});
}

TEST(PentCheck, TakesOneFile) {
    const Outcome outcome = run_program("pent-check a.pent b.pent");
    EXPECT_EQ(outcome.exit_code, 2);
    test::expect_one_error_line(outcome, "pent-check");
}

TEST(PentCheck, TellsFramesAndDimensions) {
    const test::TempFolder folder;
    const std::string out = (folder / "a.pent").string();
    write_mesh(out, test::kuhn_box<2>({1, 1}, {1, 1}));
    test::expect_contains(run_program("pent-check " + out).out, {"dimension 2", "is sound"});
    Frame<3> frame;
    frame.positions = Positions<3>::Zero(3, 5);
    frame.mesh_name = "body.pent";
    frame.frame = 7;
    frame.step = 70;
    frame.time = 0.5;
    write_frame(out, frame);
    test::expect_contains(run_program("pent-check " + out).out,
                          {"7 of body.pent, step 70, 0.5 s, 5 vertices", "is sound"});
}

TEST(PentCheck, NamesCellsThatDoNotFitAndPartsThatTouch) {
    const test::TempFolder folder;
    const std::string out = (folder / "a.pent").string();
    SimplexMesh<3> mesh;
    mesh.positions.resize(3, 7);  // the corner of a cube and its mirror image behind the origin
    mesh.positions << Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity(),
        -Eigen::Matrix3d::Identity();
    mesh.cells.resize(4, 2);
    mesh.cells << 0, 0, 1, 4, 2, 6, 3, 5;
    write_mesh(out, mesh);
    const Outcome touching = run_program("pent-check " + out);
    EXPECT_EQ(touching.exit_code, 1);
    test::expect_contains(touching.err, {"not a manifold at 1 vertices (first: 0)"});
    mesh.cells.col(1) = mesh.cells.col(0);
    write_mesh(out, mesh);
    const Outcome doubled = run_program("pent-check " + out);
    EXPECT_EQ(doubled.exit_code, 1);
    test::expect_one_error_line(doubled, "pent-check");
    test::expect_contains(doubled.err, {"a.pent: "});
}

TEST(PentCheck, RefusesADamagedFile) {
    const test::TempFolder folder;
    const std::string out = (folder / "cube.pent").string();
    ASSERT_EQ(run_program("pent-mesh --box 1,1,1,1 -o " + out).exit_code, 0);
    std::string bytes = test::text_of(out);
    bytes.back() = static_cast<char>(bytes.back() ^ 1);
    test::write_file(out, bytes);
    const Outcome outcome = run_program("pent-check " + out);
    EXPECT_EQ(outcome.exit_code, 1);
    test::expect_one_error_line(outcome, "pent-check");
}

}  // namespace
}  // namespace pent
