#include "apps/run_program.h"
#include "shapes.h"
#include "support/messages.h"

#include <gtest/gtest.h>

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
