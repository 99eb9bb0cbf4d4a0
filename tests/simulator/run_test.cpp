#include "scenes.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/error.h>
#include <pent/pent_file.h>
#include <pent/simulator/run.h>
#include <pent/simulator/scene_file.h>

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

namespace pent::simulator {
namespace {

namespace fs = std::filesystem;
using pent::test::TempFolder;

std::string read_text(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// A bar held at its left end that falls under gravity for some frames.
Scene falling_bar(const TempFolder& folder, int frames) {
    write_mesh(folder / "bar.pent", test::bar(3));
    Scene scene = test::box_scene<4>();
    scene.gravity[1] = -9.8;
    scene.frames = frames;
    scene.steps_per_frame = 2;
    scene.bodies[0].mesh = (folder / "bar.pent").string();
    scene.bodies[0].place.translate[3] = 1;
    scene.constraints = {test::hold(
        HalfSpaceSelection{.normal = Eigen::Vector4d(1, 0, 0, 0), .offset = 1e-6}, test::still(4))};
    return scene;
}

TEST(Run, WritesSceneMeshFramesAndReport) {
    const TempFolder folder;
    const Scene scene = falling_bar(folder, 3);
    const RunReport report = run(scene, {.folder = folder / "run"});
    EXPECT_EQ(report.verdict, RunVerdict::Finished);
    EXPECT_EQ(report.frames.size(), 4U);
    EXPECT_EQ(report.steps.size(), 6U);
    const MeshFile<4> mesh = read_mesh<4>(folder / "run/meshes/box.pent");
    EXPECT_EQ(mesh.mesh.positions.row(3).minCoeff(), 1);  // as placed
    const Frame<4> start = read_frame<4>(folder / "run/frames/box_000000.pent");
    EXPECT_EQ(start.positions, mesh.mesh.positions);
    EXPECT_EQ(start.mesh_crc, mesh.info.crc32c);
    const Frame<4> last = read_frame<4>(folder / "run/frames/box_000003.pent");
    EXPECT_EQ(last.frame, 3U);
    EXPECT_EQ(last.step, 6U);
    EXPECT_DOUBLE_EQ(last.time, 0.1);
    EXPECT_EQ(last.velocities.cols(), last.positions.cols());
    EXPECT_LT(last.positions.row(1).minCoeff(), start.positions.row(1).minCoeff());
    EXPECT_NE(read_text(folder / "run/report.json").find("\"verdict\": \"finished\""),
              std::string::npos);
    EXPECT_GT(report.frames.back().non_rigid[0], 0);
}

TEST(Run, WritesASceneThatRunsAgainToTheSameBytes) {
    const TempFolder folder;
    static_cast<void>(run(falling_bar(folder, 2), {.folder = folder / "run"}));
    const Scene again = read_scene(folder / "run/scene.toml");
    static_cast<void>(run(again, {.folder = folder / "again", .threads = 2}));
    EXPECT_EQ(read_text(folder / "run/frames/box_000002.pent"),
              read_text(folder / "again/frames/box_000002.pent"));
}

TEST(Run, RefusesAFolderInUseUnlessForced) {
    const TempFolder folder;
    const Scene scene = falling_bar(folder, 2);
    static_cast<void>(run(scene, {.folder = folder / "run"}));
    EXPECT_THROW(static_cast<void>(run(scene, {.folder = folder / "run"})), Error);
    Scene shorter = scene;
    shorter.frames = 1;
    static_cast<void>(run(shorter, {.folder = folder / "run", .force = true}));
    EXPECT_FALSE(fs::exists(folder / "run/frames/box_000002.pent"));
}

class Integrators : public testing::TestWithParam<Integrator> {};
INSTANTIATE_TEST_SUITE_P(All,
                         Integrators,
                         testing::Values(Integrator::LinearEuler,
                                         Integrator::NewtonEuler,
                                         Integrator::Bdf2));

TEST_P(Integrators, StopWhenAskedAndResumeToTheSameBytes) {
    const TempFolder folder;
    Scene scene = falling_bar(folder, 4);
    scene.solver.integrator = GetParam();
    static_cast<void>(run(scene, {.folder = folder / "whole"}));
    int asked = 0;
    const RunReport stopped =
        run(scene, {.folder = folder / "cut"},
            {.should_stop = [&] { return ++asked > 5; }, .on_frame = nullptr});
    EXPECT_EQ(stopped.verdict, RunVerdict::Stopped);
    EXPECT_EQ(stopped.frames.size(), 3U);
    const RunReport resumed = run(scene, {.folder = folder / "cut", .resume = true});
    EXPECT_EQ(resumed.verdict, RunVerdict::Finished);
    EXPECT_EQ(resumed.frames.size(), 5U);
    EXPECT_EQ(resumed.steps.size(), 8U);
    for (const char* frame : {"box_000003.pent", "box_000004.pent"}) {
        EXPECT_EQ(read_text(folder / "whole/frames" / frame),
                  read_text(folder / "cut/frames" / frame));
    }
}

TEST(Run, RemovesWhatAKilledRunLeftHalfWrittenWhenItIsResumed) {
    const TempFolder folder;
    const Scene scene = falling_bar(folder, 1);
    static_cast<void>(run(scene, {.folder = folder / "run"}));
    const fs::path half = folder / "run/frames/.box_000002.pent.4711.tmp";
    const fs::path own = folder / "run/frames/.mine";
    std::ofstream(half) << "PENT";
    std::ofstream(own) << "mine";
    static_cast<void>(run(scene, {.folder = folder / "run", .resume = true}));
    EXPECT_FALSE(fs::exists(half));
    EXPECT_TRUE(fs::exists(own));
}

// BDF2 needs the step before, and that is kept for the last two frames only.
TEST(Run, RefusesToResumeFromAFrameWhoseStepBeforeIsNotKept) {
    const TempFolder folder;
    Scene scene = falling_bar(folder, 4);
    scene.solver.integrator = Integrator::Bdf2;
    static_cast<void>(run(scene, {.folder = folder / "run"}));
    for (const char* frame : {"box_000003.pent", "box_000004.pent"}) {
        fs::remove(folder / "run/frames" / frame);
    }
    EXPECT_NE(pent::test::error_of([&] {
                  static_cast<void>(run(scene, {.folder = folder / "run", .resume = true}));
              }).find("box_000002.pent: is not kept so far back"),
              std::string::npos);
}

TEST(Run, PutsTheWarningsOfTheSimulationIntoItsReport) {
    const TempFolder folder;
    Scene scene = falling_bar(folder, 1);
    scene.contact = Contact{.distance = 0.2, .self = true};
    std::vector<std::string> told;
    const RunReport report =
        run(scene, {.folder = folder / "run"},
            {.should_stop = nullptr,
             .on_frame = nullptr,
             .on_warning = [&](const std::string& warning) { told.push_back(warning); }});
    ASSERT_EQ(report.warnings.size(), 1U);
    EXPECT_EQ(told, report.warnings);
    EXPECT_NE(read_text(folder / "run/report.json").find(report.warnings[0]), std::string::npos);
}

TEST(Run, RefusesToResumeAnotherScene) {
    const TempFolder folder;
    Scene scene = falling_bar(folder, 1);
    static_cast<void>(run(scene, {.folder = folder / "run"}));
    scene.gravity[1] = 3;
    EXPECT_THROW(static_cast<void>(run(scene, {.folder = folder / "run", .resume = true})), Error);
    EXPECT_THROW(static_cast<void>(run(scene, {.folder = folder / "none", .resume = true})), Error);
}

TEST(Run, EndsADivergingRunWithAVerdictAndNoBadFrame) {
    const TempFolder folder;
    Scene scene = falling_bar(folder, 3);
    scene.solver.max_iterations = 1;
    scene.solver.max_halvings = 1;
    const RunReport report = run(scene, {.folder = folder / "run"});
    EXPECT_EQ(report.verdict, RunVerdict::Diverged);
    EXPECT_NE(report.message.find("try"), std::string::npos);
    EXPECT_TRUE(fs::exists(folder / "run/frames/box_000000.pent"));
    EXPECT_FALSE(fs::exists(folder / "run/frames/box_000001.pent"));
    EXPECT_NE(read_text(folder / "run/report.json").find("diverged"), std::string::npos);
}

TEST(Run, RunsInThreeDimensions) {
    const TempFolder folder;
    write_mesh(folder / "cube.pent", pent::test::kuhn_box<3>({2, 2, 2}, {1, 1, 1}));
    Scene scene = test::box_scene<3>();
    scene.gravity[2] = -1;
    scene.frames = 2;
    scene.bodies[0].mesh = (folder / "cube.pent").string();
    EXPECT_EQ(run(scene, {.folder = folder / "run"}).frames.size(), 3U);
    EXPECT_EQ(read_frame<3>(folder / "run/frames/box_000002.pent").frame, 2U);
}

TEST(Run, LeavesNothingBehindForAMeshThatIsNotThere) {
    const TempFolder folder;
    Scene scene = test::box_scene<4>();
    scene.bodies[0].mesh = (folder / "none.pent").string();
    EXPECT_THROW(static_cast<void>(run(scene, {.folder = folder / "run"})), Error);
    EXPECT_FALSE(fs::exists(folder / "run"));
}

}  // namespace
}  // namespace pent::simulator
