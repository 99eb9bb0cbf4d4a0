#include "apps/run_program.h"
#include "shapes.h"
#include "support/kuhn_box.h"
#include "support/messages.h"

#include <pent/pent_file.h>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace pent {
namespace {

using test::Outcome;
using test::run_program;

TEST(PentCheck, ProvesTheTables) {
    const Outcome outcome = run_program("pent-check");
    EXPECT_EQ(outcome.exit_code, 0);
    test::expect_contains(outcome.out, {"720 of 720", "211", "436", "975", "9056", "5120", "0.386",
                                        "finished: all proved"});
}

TEST(PentCheck, SaysWhenItsReportCannotBeWritten) {
    const Outcome sound = run_program("pent-check --json /dev/null/folder/report.json");
    EXPECT_EQ(sound.exit_code, 1);
    test::expect_one_error_line(sound, "pent-check");
    test::expect_contains(sound.err, {"/dev/null/folder: folder cannot be made"});
    // What is wrong with the input is more to the point.
    const Outcome missing = run_program("pent-check none.pent --json /dev/null/folder/report.json");
    EXPECT_EQ(missing.exit_code, 1);
    test::expect_one_error_line(missing, "pent-check");
    test::expect_contains(missing.err, {"none.pent"});
}

TEST(PentCheck, NeverWritesItsReportOverTheFile) {
    const test::TempFolder folder;
    const std::string out = (folder / "a.pent").string();
    write_mesh(out, test::kuhn_box<2>({1, 1}, {1, 1}));
    const std::string before = test::text_of(out);
    const Outcome outcome = run_program("pent-check " + out + " --json " + out);
    EXPECT_EQ(outcome.exit_code, 1);
    test::expect_contains(outcome.err, {"--json is the same file as the input"});
    EXPECT_TRUE(test::text_of(out) == before);
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

TEST(PentCheck, ReportsWhatItSays) {
    const test::TempFolder folder;
    const std::string out = (folder / "a.pent").string();
    const SimplexMesh<2> mesh = test::kuhn_box<2>({1, 1}, {1, 1});
    MeshExtras<2> extras;
    extras.vertex_fields = {{"heat", Eigen::MatrixXd::Zero(1, mesh.vertex_count())}};
    extras.cell_fields = {{"age", Eigen::MatrixXd::Zero(1, mesh.cell_count())}};
    extras.boundary.resize(2, 3);
    extras.boundary << 0, 1, 3, 1, 3, 2;
    extras.labels = {7, 2, 7};
    extras.bisection_tags = {0, 1};
    write_mesh(out, mesh, {.created_by = "a test"}, extras);
    const std::string json = (folder / "a.json").string();
    const Outcome outcome = run_program("pent-check " + out + " --json " + json);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    test::expect_contains(outcome.out,
                          {"binary, by a test, crc32c ", "quantities heat, age of cells", "tags ",
                           "labels     2 on 1 facet, 7 on 2 facets"});
    const auto report = nlohmann::json::parse(test::text_of(json));
    EXPECT_EQ(report["file"]["encoding"], "binary");
    EXPECT_EQ(report["file"]["created_by"], "a test");
    test::expect_contains(outcome.out, {report["file"]["crc32c"].get<std::string>()});
    EXPECT_EQ(report["extras"], nlohmann::json::parse(
                                    R"({"vertex_fields": ["heat"], "cell_fields": ["age"],
                                        "has_bisection_tags": true, "labels": {"2": 1, "7": 2}})"));
}

TEST(PentCheck, SaysWhatCellsHave) {
    const test::TempFolder folder;
    const std::string out = (folder / "a.pent").string();
    const std::string json = (folder / "a.json").string();
    SimplexMesh<2> mesh = test::kuhn_box<2>({2, 1}, {1, 1});
    ASSERT_EQ(mesh.cell_count(), 4);
    mesh.regions = {0, 3, 3, 3};
    mesh.fibers = Positions<2>::Zero(2, 4);
    mesh.fibers.col(1) << 1, 0;
    write_mesh(out, mesh);
    const Outcome outcome = run_program("pent-check " + out + " --json " + json);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    test::expect_contains(outcome.out,
                          {"\nregions    0 on 1 cell, 3 on 3 cells\n", "\nfibers     in 1 cell\n"});
    EXPECT_EQ(nlohmann::json::parse(test::text_of(json))["cells"],
              nlohmann::json::parse(
                  R"({"regions": {"0": 1, "3": 3}, "with_fibers": 1, "is_quadratic": false})"));
    mesh.regions = {0, 0, 0, 0};  // as without any
    mesh.fibers.resize(2, 0);
    write_mesh(out, mesh);
    const std::string plain = run_program("pent-check " + out).out;
    EXPECT_EQ(plain.find("regions"), std::string::npos);
    EXPECT_EQ(plain.find("fibers"), std::string::npos);
}

TEST(PentCheck, SaysThatCellsAreChildrenOfQuadraticOnes) {
    const test::TempFolder folder;
    const std::string out = (folder / "a.pent").string();
    ASSERT_EQ(run_program("pent-mesh --box 1,1,1,1 --cut corners --quadratic -o " + out).exit_code,
              0);
    test::expect_contains(run_program("pent-check " + out).out,
                          {"quadratic  16 cells of which these are the children"});
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
    test::expect_contains(touching.err, {"not a manifold at 1 vertex (first: 0)"});
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
