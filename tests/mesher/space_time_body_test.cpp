#include "apps/run_program.h"
#include "moving_shapes.h"
#include "shapes.h"
#include "support/messages.h"

#include <pent/mesher/shapes.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace pent {
namespace {

using test::Outcome;
using test::run_program;

// A ball that swells from radius 1 to 2, in three frames.
std::string write_swelling_ball(const std::filesystem::path& folder) {
    std::string pvd = "<VTKFile type=\"Collection\"><Collection>\n";
    SimplexMesh<3> ball = mesher::ball(2);
    for (int i = 0; i < 3; ++i) {
        const std::string name = "ball_" + std::to_string(i) + ".vtu";
        const test::VtuParts parts{ball.positions * (1 + 0.5 * i), ball.cells, {}, {}, {}, {}};
        test::write_file(folder / name, test::to_vtu(parts, {"binary", true, true}));
        pvd += "<DataSet timestep=\"" + std::to_string(i) + "\" file=\"" + name + "\"/>\n";
    }
    test::write_file(folder / "ball.pvd", pvd + "</Collection></VTKFile>\n");
    return (folder / "ball.pvd").string();
}

TEST(PentMesh, MakesSpaceTimeMeshesWithTheSameBytesAtAnyNumberOfThreads) {
    const test::TempFolder folder;
    const std::string pvd = write_swelling_ball(folder.path());
    std::string first;
    for (const char* threads : {"1", "2", "3"}) {
        const std::string out = (folder / threads).string() + ".pent";
        const Outcome outcome =
            run_program("pent-mesh " + pvd + " --space-time --time-scale 0.5 --bisection -o " + out
                        + " --threads " + threads + " --json " + (folder / "r.json").string());
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        test::expect_contains(outcome.out, {"time       w = 0.5 m/s * t; 2 layers of 0.5 m",
                                            "bisection  ready after a barycentric cut",
                                            "w 0 to 1 m", "integral   of the moving volume"});
        const std::string bytes = test::text_of(out);
        first = first.empty() ? bytes : first;
        EXPECT_TRUE(bytes == first) << threads << " threads";
    }
    test::expect_contains(run_program("pent-check " + (folder / "1.pent").string()).out,
                          {"is sound", "labels     1 on ", "tags       "});
    test::expect_contains(test::text_of(folder / "r.json"), {"\"frames\": 3", "\"integral\""});
}

TEST(PentMesh, SaysWhereTimeZeroIsAlongW) {
    const test::TempFolder folder;
    const std::string pvd = write_swelling_ball(folder.path());
    const Outcome outcome =
        run_program("pent-mesh " + pvd + " --space-time --translate 0,0,0,-3 -o "
                    + (folder / "a.pent").string());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    test::expect_contains(outcome.out,
                          {"time       w = 1 m/s * t - 3 m; 2 layers", "w -3 to -1 m"});
}

TEST(PentMesh, WritesASpaceTimeMeshAsSlabs) {
    const test::TempFolder folder;
    const std::string pvd = write_swelling_ball(folder.path());
    const Outcome outcome = run_program("pent-mesh " + pvd + " --space-time --slabs -o "
                                        + (folder / "out" / "b.pent").string());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    for (const char* name : {"b_000000.pent", "b_000001.pent"}) {
        EXPECT_EQ(run_program("pent-check " + (folder / "out" / name).string()).exit_code, 0);
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "out" / "b.pent"));
}

// The second slab cannot be written where a folder is.
TEST(PentMesh, LeavesSlabsOfBeforeWhereOneCannotBeWritten) {
    const test::TempFolder folder;
    const std::string pvd = write_swelling_ball(folder.path());
    const std::filesystem::path out = folder / "out";
    std::filesystem::create_directories(out / "b_000001.pent");
    test::write_file(out / "elsewhere.pent", "of before");
    std::filesystem::create_symlink("elsewhere.pent", out / "b_000000.pent");
    const std::string command = "pent-mesh " + pvd + " --space-time --slabs -o ";
    const Outcome refused = run_program(command + (out / "b.pent").string());
    EXPECT_EQ(refused.exit_code, 1);
    test::expect_one_error_line(refused, "pent-mesh");
    test::expect_contains(refused.err, {"b_000001.pent", "folder"});
    EXPECT_EQ(test::text_of(out / "b_000000.pent"), "of before");
    std::filesystem::remove(out / "b_000001.pent");
    ASSERT_EQ(run_program(command + (out / "b.pent").string()).exit_code, 0);
    EXPECT_TRUE(std::filesystem::is_symlink(out / "b_000000.pent"));
    EXPECT_EQ(run_program("pent-check " + (out / "elsewhere.pent").string()).exit_code, 0);
    // The slabs, what one of them leads to, and nothing else.
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(out), {}), 3);
    const std::string frame = (folder / "ball_1.vtu").string();
    const std::string before = test::text_of(frame);
    std::filesystem::create_symlink(frame, out / "c_000001.pent");
    test::expect_contains(run_program(command + (out / "c.pent").string()).err,
                          {"a slab is the same file as a file that the input names"});
    EXPECT_EQ(test::text_of(frame), before);
}

TEST(PentMesh, NeverWritesWhereAMovingMeshIsRead) {
    const test::TempFolder folder;
    const std::string pvd = write_swelling_ball(folder.path());
    const std::string frame = (folder / "ball_1.vtu").string();
    const std::string before = test::text_of(frame);
    const std::string command =
        "pent-mesh " + pvd + " --space-time -o " + (folder / "out.pent").string();
    for (const std::string& output : {" --json " + frame, " --histogram " + frame}) {
        const Outcome outcome = run_program(command + output);
        EXPECT_EQ(outcome.exit_code, 1) << output;
        test::expect_contains(outcome.err, {"is the same file as a file that the input names"});
    }
    const std::string slab = (folder / "out_000001.pent").string();
    for (const std::string& output : {" --json " + slab, " --histogram " + slab}) {
        const Outcome outcome = run_program(command + " --slabs" + output);
        EXPECT_EQ(outcome.exit_code, 1) << output;
        test::expect_contains(outcome.err, {"is the same file as a slab"});
    }
    EXPECT_EQ(test::text_of(frame), before);
    EXPECT_FALSE(std::filesystem::exists(folder / "out.pent"));
    EXPECT_FALSE(std::filesystem::exists(slab));
    const std::filesystem::path run = folder / "run";
    std::filesystem::create_directory(run);
    for (const std::string& output :
         {" -o " + (run / "a.pent").string(),
          " -o " + (folder / "a.pent").string() + " --json " + (run / "report.json").string()}) {
        const Outcome outcome = run_program("pent-mesh " + run.string() + " --space-time" + output);
        EXPECT_EQ(outcome.exit_code, 1) << output;
        test::expect_contains(outcome.err, {" is in the input, ", "give it another name"});
        EXPECT_TRUE(std::filesystem::is_empty(run));
    }
}

TEST(PentMesh, SaysWhatIsWrongWithAMovingMeshAndWritesNothing) {
    const test::TempFolder folder;
    const std::string pvd = write_swelling_ball(folder.path());
    const std::string out = " -o " + (folder / "out.pent").string();
    for (const auto& [options, message] : std::vector<std::pair<std::string, std::string>>{
             {" --space-time --layers 3", "--layers: without meaning for a moving mesh"},
             {" --space-time --spacing 1,1,1,1", "--spacing: without meaning for a moving mesh"},
             {" --space-time --body a", "--body: without meaning for"},
             {" --space-time --dim 3", "a space-time mesh has four dimensions"},
             {" --space-time --refine-time often", "expected auto or a whole number"},
             {" --space-time --every 3", "one frame of every 3 leaves one"},
             {" --space-time --time-step 1", "has times itself"}}) {
        const Outcome outcome = run_program("pent-mesh " + pvd + options + out);
        EXPECT_EQ(outcome.exit_code, 1) << options;
        test::expect_one_error_line(outcome, "pent-mesh");
        test::expect_contains(outcome.err, {message});
    }
    const Outcome nothing =
        run_program("pent-mesh " + (folder / "RUN").string() + " --space-time --body a" + out);
    test::expect_one_error_line(nothing, "pent-mesh");
    test::expect_contains(nothing.err, {"RUN: expected a list of frames", "or a run folder"});
    EXPECT_EQ(run_program("pent-mesh " + pvd + " --time-scale 2" + out).exit_code, 2);
    EXPECT_EQ(run_program("pent-mesh " + pvd + out).exit_code, 1);
    std::filesystem::resize_file(folder / "ball_1.vtu", 900);
    const Outcome cut = run_program("pent-mesh " + pvd + " --space-time" + out);
    EXPECT_EQ(cut.exit_code, 1);
    test::expect_one_error_line(cut, "pent-mesh");
    test::expect_contains(cut.err, {"ball_1.vtu: line "});
    EXPECT_FALSE(std::filesystem::exists(folder / "out.pent"));
}

}  // namespace
}  // namespace pent
