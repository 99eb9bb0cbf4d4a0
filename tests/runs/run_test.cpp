#include "falling_bar.h"
#include "simulator/scenes.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/obstacles_file.h>
#include <pent/pent_file.h>
#include <pent/runs/run.h>
#include <pent/runs/scene_file.h>

#include <gtest/gtest.h>

#include <fstream>

namespace pent::runs {
namespace {

using namespace simulator;

namespace fs = std::filesystem;
using pent::test::TempFolder;
using test::bytes_of;
using test::falling_bar;

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
    EXPECT_NE(bytes_of(folder / "run/report.json").find("\"verdict\": \"finished\""),
              std::string::npos);
    EXPECT_GT(report.frames.back().non_rigid[0].value, 0);
}

// What a viewer needs to show them; nothing is left of those of a run that was replaced.
TEST(Run, WritesTheObstaclesOfItsScene) {
    const TempFolder folder;
    Scene scene = falling_bar(folder, 1);
    scene.obstacles = {
        {.shape = HalfSpaceObstacle{.normal = Eigen::Vector4d::UnitY(), .offset = -3}},
        {.shape = BallObstacle{.center = Eigen::Vector4d(1, 2, 3, 4), .radius = 0.5}},
        {.shape = CavityObstacle{.center = Eigen::Vector4d::Zero(), .radius = 9}},
        {.shape = BowlObstacle{
             .center = Eigen::Vector4d::Zero(), .radius = 8, .up = Eigen::Vector4d::UnitY()}}};
    static_cast<void>(run(scene, {.folder = folder / "run"}));
    const auto obstacles = read_obstacles<4>(folder / "run/obstacles.json");
    ASSERT_EQ(obstacles.size(), 4U);
    EXPECT_EQ(std::get<HalfSpace<4>>(obstacles[0]).offset, -3);
    EXPECT_EQ(std::get<Ball<4>>(obstacles[1]).center, Eigen::Vector4d(1, 2, 3, 4));
    EXPECT_EQ(std::get<Cavity<4>>(obstacles[2]).radius, 9);
    EXPECT_EQ(std::get<Bowl<4>>(obstacles[3]).up, Eigen::Vector4d::UnitY());
    scene.obstacles.clear();
    static_cast<void>(run(scene, {.folder = folder / "run", .force = true}));
    EXPECT_FALSE(fs::exists(folder / "run/obstacles.json"));
}

TEST(Run, WritesWhereObstaclesAreAtEachFrameWhereTheyMove) {
    const TempFolder folder;
    Scene scene = falling_bar(folder, 2);
    Motion up;
    up.translate = Eigen::Vector4d(0, 3, 0, 0);
    scene.obstacles = {
        {.shape = BallObstacle{.center = Eigen::Vector4d(9, -9, 9, 9), .radius = 0.5},
         .motion = {up}}};
    static_cast<void>(run(scene, {.folder = folder / "run"}));
    EXPECT_FALSE(fs::exists(folder / "run/obstacles.json"));
    for (int frame = 0; frame <= 2; ++frame) {
        const auto obstacles =
            read_obstacles<4>(folder / "run" / formatted("obstacles/%06d.json", frame));
        EXPECT_NEAR(std::get<Ball<4>>(obstacles.at(0)).center[1],
                    -9 + 3 * frame / scene.frames_per_second, 1e-12);
    }
}

TEST(Run, WritesASceneThatRunsAgainToTheSameBytes) {
    const TempFolder folder;
    static_cast<void>(run(falling_bar(folder, 2), {.folder = folder / "run"}));
    const Scene again = read_scene(folder / "run/scene.toml");
    static_cast<void>(run(again, {.folder = folder / "again", .threads = 2}));
    EXPECT_EQ(bytes_of(folder / "run/frames/box_000002.pent"),
              bytes_of(folder / "again/frames/box_000002.pent"));
}

// What pent-study makes meshes of stands beside the scene, not in the run.
TEST(Run, WritesRecipesThatFindTheirFilesFromItsFolder) {
    const TempFolder folder;
    Scene scene = falling_bar(folder, 1);
    std::ofstream(folder / "model.off") << "OFF\n";
    scene.bodies[0].recipe = "model.off  --thickness 1\t--profile none.csv ";
    static_cast<void>(
        run(scene, {.folder = folder / "deep/run", .scene_file = folder / "scene.toml"}));
    EXPECT_EQ(read_scene(folder / "deep/run/scene.toml").bodies[0].recipe,
              "../../model.off  --thickness 1\t--profile none.csv ");
    std::filesystem::create_directory(folder / "my models");
    std::ofstream(folder / "my models/lean.txt") << "0 1\n1 1\n";
    scene.bodies[0].recipe = "\"model.off\" --profile='my models/lean.txt' 'my models/none'";
    static_cast<void>(
        run(scene, {.folder = folder / "my models/run", .scene_file = folder / "scene.toml"}));
    EXPECT_EQ(read_scene(folder / "my models/run/scene.toml").bodies[0].recipe,
              "../../model.off --profile=../lean.txt 'my models/none'");
    static_cast<void>(
        run(scene, {.folder = folder / "deep/quotes", .scene_file = folder / "scene.toml"}));
    EXPECT_EQ(read_scene(folder / "deep/quotes/scene.toml").bodies[0].recipe,
              "../../model.off --profile=\"../../my models/lean.txt\" 'my models/none'");
    const std::string absolute = (folder / "model.off").string() + " --layers 2";
    scene.bodies[0].recipe = absolute;
    static_cast<void>(run(scene, {.folder = folder / "run", .scene_file = folder / "scene.toml"}));
    EXPECT_EQ(read_scene(folder / "run/scene.toml").bodies[0].recipe, absolute);
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

// A project whose own folders have the names that those of a run have.
TEST(Run, RefusesAFolderThatIsNotOfARunWhateverIsAsked) {
    const TempFolder folder;
    Scene scene = falling_bar(folder, 1);
    const std::vector<std::string> own = {"meshes/box.pent", "frames/mine.pent", "report.json",
                                          "contacts/000000.csv"};
    for (const std::string& name : own) {
        fs::create_directories((folder / ("project/" + name)).parent_path());
        std::ofstream(folder / ("project/" + name)) << "mine";
    }
    fs::copy_file(folder / "bar.pent", folder / "project/meshes/bar.pent");
    scene.bodies[0].mesh = (folder / "project/meshes/bar.pent").string();
    for (const bool force : {false, true}) {
        const RunOptions options{.folder = folder / "project", .force = force};
        EXPECT_NE(pent::test::error_of([&] {
                      static_cast<void>(run(scene, options));
                  }).find("stays as it is"),
                  std::string::npos);
        for (const std::string& name : own) {
            EXPECT_EQ(bytes_of(folder / ("project/" + name)), "mine") << name;
        }
        EXPECT_TRUE(fs::exists(folder / "project/meshes/bar.pent"));
    }
}

TEST(Run, ReplacesWhatTheRunWroteAndNothingElse) {
    const TempFolder folder;
    const Scene scene = falling_bar(folder, 1);
    const RunOptions options{.folder = folder / "run", .force = true};
    static_cast<void>(run(scene, options));
    const std::vector<std::string> own = {"notes.txt", "meshes/mine.pent", "frames/notes.txt",
                                          "frames/box_000009.pent", "checkpoint/mine"};
    for (const std::string& name : own) {
        fs::create_directories((folder / ("run/" + name)).parent_path());
        std::ofstream(folder / ("run/" + name)) << "mine";
    }
    static_cast<void>(run(scene, options));
    for (const std::string& name : own) {
        EXPECT_EQ(bytes_of(folder / ("run/" + name)), "mine") << name;
    }
}

TEST(Run, NeverReplacesWhatTheSceneReads) {
    const TempFolder folder;
    Scene scene = falling_bar(folder, 1);
    static_cast<void>(run(scene, {.folder = folder / "run"}));
    const RunOptions options{.folder = folder / "run", .force = true};
    RunOptions from_scene_of_run = options;
    from_scene_of_run.scene_file = folder / "run/scene.toml";
    EXPECT_NE(pent::test::error_of([&] {
                  static_cast<void>(run(scene, from_scene_of_run));
              }).find("scene.toml: is read"),
              std::string::npos);
    scene.bodies[0].mesh = (folder / "run/meshes/box.pent").string();
    EXPECT_NE(pent::test::error_of([&] {
                  static_cast<void>(run(scene, options));
              }).find("meshes/box.pent: is read"),
              std::string::npos);
    EXPECT_TRUE(fs::exists(folder / "run/meshes/box.pent"));
    EXPECT_TRUE(fs::exists(folder / "run/frames/box_000001.pent"));
}

TEST(Run, PutsTheWarningsOfTheSimulationIntoItsReport) {
    const TempFolder folder;
    Scene scene = falling_bar(folder, 1);
    scene.contact = ContactSettings{.distance = 0.2, .self = true};
    std::vector<std::string> told;
    const RunReport report =
        run(scene, {.folder = folder / "run"},
            {.should_stop = nullptr,
             .on_frame = nullptr,
             .on_warning = [&](const std::string& warning) { told.push_back(warning); }});
    ASSERT_EQ(report.warnings.size(), 2U);
    pent::test::expect_contains(report.warnings[0], {"mean surface edge"});
    pent::test::expect_contains(report.warnings[1],
                                {"[contact] distance = 0.2 m", "a tenth of \"box\"", "scale"});
    EXPECT_EQ(told, report.warnings);
    pent::test::expect_contains(bytes_of(folder / "run/report.json"), {"mean surface edge"});
}

TEST(Run, SaysWhereInTheSceneAMeshIsMissingOrOfAnotherDimension) {
    const TempFolder folder;
    write_mesh(folder / "cube.pent", pent::test::kuhn_box<3>({1, 1, 1}, {1, 1, 1}));
    const auto message = [&](const std::string& mesh) {
        std::ofstream(folder / "s.toml") << "[[body]]\nname = 'a'\nmesh = '" << mesh << "'\n";
        return pent::test::error_of([&] {
            static_cast<void>(run(read_scene(folder / "s.toml"), {.folder = folder / "run"}));
        });
    };
    pent::test::expect_contains(message("none.pent"),
                                {"s.toml:3:8: ", "none.pent: cannot be read: No such file"});
    pent::test::expect_contains(message("cube.pent"),
                                {"s.toml:3:8: ", "is of dimension 3", "[scene] dimension = 3"});
    EXPECT_FALSE(fs::exists(folder / "run"));
}

TEST(Run, SaysWhereInTheSceneTwoConstraintsSelectOneVertex) {
    const TempFolder folder;
    static_cast<void>(falling_bar(folder, 1));
    std::ofstream(folder / "s.toml") << R"([[body]]
name = "a"
mesh = "bar.pent"
[[constraint]]
body = "a"
select = { layers = { first = 0 } }
[[constraint]]
body = "a"
select = { layers = { first = 0, last = 1 } }
)";
    pent::test::expect_contains(
        pent::test::error_of([&] {
            static_cast<void>(run(read_scene(folder / "s.toml"), {.folder = folder / "run"}));
        }),
        {"s.toml:9:10: vertex 0 of body \"a\"", "and that at", "s.toml:6:10"});
}

TEST(Run, RefusesAMeshTooSmallForItsVolumes) {
    const TempFolder folder;
    Scene scene = falling_bar(folder, 1);
    SimplexMesh<4> mesh = read_mesh<4>(folder / "bar.pent").mesh;
    mesh.positions *= 1e-90;
    write_mesh(folder / "bar.pent", mesh);
    pent::test::expect_contains(
        pent::test::error_of([&] { static_cast<void>(run(scene, {.folder = folder / "run"})); }),
        {"body \"box\"", "m large; expected a size from 1e-30"});
}

// A cell twice: pent-check refuses it; where contact needs a closed surface so does a run.
TEST(Run, WarnsOfCellsThatDoNotFitTogetherAndRefusesThemWithContact) {
    const TempFolder folder;
    Scene scene = falling_bar(folder, 1);
    SimplexMesh<4> mesh = read_mesh<4>(folder / "bar.pent").mesh;
    mesh.cells.conservativeResize(5, mesh.cells.cols() + 1);
    mesh.cells.rightCols(1) = mesh.cells.leftCols(1);
    write_mesh(folder / "bar.pent", mesh);
    const RunReport report = run(scene, {.folder = folder / "run"});
    ASSERT_EQ(report.warnings.size(), 1U);
    pent::test::expect_contains(report.warnings[0],
                                {"bar.pent", "do not fit together", "pent-check"});
    scene.contact = ContactSettings{};
    pent::test::expect_contains(
        pent::test::error_of([&] { static_cast<void>(run(scene, {.folder = folder / "touch"})); }),
        {"bar.pent", "contact needs a closed surface"});
}

TEST(Run, EndsADivergingRunWithAVerdictAndNoBadFrame) {
    const TempFolder folder;
    Scene scene = falling_bar(folder, 3);
    scene.solver.max_iterations = 1;
    scene.solver.max_halvings = 1;
    const RunReport report = run(scene, {.folder = folder / "run"});
    EXPECT_EQ(report.verdict, RunVerdict::Diverged);
    pent::test::expect_contains(report.message,
                                {"linear solver did not reach", "; try a larger solver.max_"});
    EXPECT_TRUE(fs::exists(folder / "run/frames/box_000000.pent"));
    EXPECT_FALSE(fs::exists(folder / "run/frames/box_000001.pent"));
    EXPECT_NE(bytes_of(folder / "run/report.json").find("diverged"), std::string::npos);
}

TEST(Run, RunsInThreeDimensions) {
    const TempFolder folder;
    write_mesh(folder / "cube.pent", pent::test::kuhn_box<3>({2, 2, 2}, {1, 1, 1}));
    Scene scene = simulator::test::box_scene<3>();
    scene.gravity[2] = -1;
    scene.frames = 2;
    scene.bodies[0].mesh = (folder / "cube.pent").string();
    EXPECT_EQ(run(scene, {.folder = folder / "run"}).frames.size(), 3U);
    EXPECT_EQ(read_frame<3>(folder / "run/frames/box_000002.pent").frame, 2U);
}

TEST(Run, LeavesNothingBehindForAMeshThatIsNotThere) {
    const TempFolder folder;
    Scene scene = simulator::test::box_scene<4>();
    scene.bodies[0].mesh = (folder / "none.pent").string();
    EXPECT_THROW(static_cast<void>(run(scene, {.folder = folder / "run"})), Error);
    EXPECT_FALSE(fs::exists(folder / "run"));
}

}  // namespace
}  // namespace pent::runs
