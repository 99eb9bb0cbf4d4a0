#include "record/checkpoint_file.h"
#include "simulator/scenes.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/error.h>
#include <pent/obstacles_file.h>
#include <pent/pent_file.h>
#include <pent/runs/run.h>
#include <pent/runs/scene_file.h>

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

namespace pent::runs {
namespace {

using namespace simulator;
namespace test = simulator::test;

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
            EXPECT_EQ(read_text(folder / ("project/" + name)), "mine") << name;
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
        EXPECT_EQ(read_text(folder / ("run/" + name)), "mine") << name;
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

// One may work in the folder of a run: more frames, in its own scene file, with a comment.
TEST(Run, LeavesTheSceneFileThatItIsResumedFromAsItIs) {
    const TempFolder folder;
    static_cast<void>(run(falling_bar(folder, 1), {.folder = folder / "run"}));
    const fs::path file = folder / "run/scene.toml";
    std::string text = read_text(file);
    text.replace(text.find("frames = 1"), 10, "frames = 2  # mine");
    std::ofstream(file) << text;
    static_cast<void>(
        run(read_scene(file), {.folder = folder / "run", .scene_file = file, .resume = true}));
    EXPECT_EQ(read_text(file), text);
    EXPECT_TRUE(fs::exists(folder / "run/frames/box_000002.pent"));
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
    const fs::path half = folder / "run/frames/.box_000001.pent.4711.tmp";
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
              }).find("000002.state: cannot be gone on from: it is not there"),
              std::string::npos);
}

// The scene, its mesh and the run may all have moved, apart from one another.
TEST(Run, ResumesWhereverItWasMovedOrCopiedTo) {
    const TempFolder folder;
    Scene scene = falling_bar(folder, 1);
    scene.solver.integrator = Integrator::Bdf2;
    static_cast<void>(run(scene, {.folder = folder / "run"}));
    fs::create_directories(folder / "elsewhere/deep");
    fs::copy(folder / "run", folder / "elsewhere/deep/run", fs::copy_options::recursive);
    fs::rename(folder / "bar.pent", folder / "elsewhere/other.pent");
    scene.bodies[0].mesh = (folder / "elsewhere/other.pent").string();
    scene.frames = 3;
    const RunReport report = run(scene, {.folder = folder / "elsewhere/deep/run", .resume = true});
    EXPECT_EQ(report.frames.size(), 4U);
    static_cast<void>(run(scene, {.folder = folder / "whole"}));
    EXPECT_EQ(read_text(folder / "whole/frames/box_000003.pent"),
              read_text(folder / "elsewhere/deep/run/frames/box_000003.pent"));
}

// Labels decide what is held and how unknowns are numbered: positions and cells alone are not the
// mesh.
TEST(Run, RefusesToResumeWithAMeshOfOtherLabels) {
    const TempFolder folder;
    const Scene scene = falling_bar(folder, 1);
    static_cast<void>(run(scene, {.folder = folder / "run"}));
    SimplexMesh<4> mesh = read_mesh<4>(folder / "bar.pent").mesh;
    mesh.layers[0] += 1;
    write_mesh(folder / "bar.pent", mesh);
    EXPECT_NE(pent::test::error_of([&] {
                  static_cast<void>(run(scene, {.folder = folder / "run", .resume = true}));
              }).find("is another mesh"),
              std::string::npos);
}

// Three parts, of which the second was killed while it wrote: the last tells of all.
TEST(Run, TellsOfAllItsPartsHoweverTheyEnded) {
    const TempFolder folder;
    Scene scene = falling_bar(folder, 2);
    const fs::path out = folder / "run";
    static_cast<void>(run(scene, {.folder = out}));
    scene.frames = 4;
    static_cast<void>(run(scene, {.folder = out, .resume = true}));
    // What a kill leaves: no end, half a line, and a report that is seconds old.
    std::string journal = read_text(out / "journal.txt");
    journal.erase(journal.rfind('\n', journal.size() - 2) + 1);
    std::ofstream(out / "journal.txt", std::ios::binary) << journal << "0123";
    fs::remove(out / "report.json");
    scene.frames = 5;
    std::string told;
    const RunReport report = run(scene, {.folder = out, .resume = true},
                                 {.should_stop = nullptr,
                                  .on_frame = nullptr,
                                  .on_warning = nullptr,
                                  .on_resume = [&](const std::string& line) { told = line; }});
    EXPECT_EQ(told,
              "the run had died (it was killed or crashed) behind frame 4; it goes on from there");
    ASSERT_EQ(report.frames.size(), 6U);
    ASSERT_EQ(report.steps.size(), 10U);
    for (std::size_t i = 0; i < 10; ++i) {
        EXPECT_EQ(report.steps[i].step, i + 1);
    }
    ASSERT_EQ(report.parts.size(), 3U);
    EXPECT_EQ(report.parts[0].verdict, "finished");
    EXPECT_EQ(report.parts[1].verdict, "died");
    EXPECT_EQ(report.parts[1].first_frame, 2);
    EXPECT_EQ(report.parts[1].last_frame, 4);
    EXPECT_GT(report.parts[1].seconds, 0);
    EXPECT_EQ(report.parts[2].verdict, "finished");
    EXPECT_EQ(report.parts[2].first_frame, 4);
    const std::string text = read_text(out / "report.json");
    pent::test::expect_contains(text, {"\"died\"", "\"step\": 10"});
}

// What is believed on the way back in has a checksum: the journal, line by line, which has the
// instruction set; and the headers of frames.
TEST(Run, RefusesToResumeFromAJournalOrAFrameThatWasChanged) {
    const TempFolder folder;
    Scene scene = falling_bar(folder, 1);
    const fs::path out = folder / "run";
    static_cast<void>(run(scene, {.folder = out, .isa = "scalar"}));
    scene.frames = 2;
    const auto resume_with = [&](const fs::path& file, const std::string& from,
                                 const std::string& to) {
        const std::string good = read_text(file);
        std::string bad = good;
        bad.replace(bad.find(from), from.size(), to);
        std::ofstream(file, std::ios::binary) << bad;
        const std::string error = pent::test::error_of(
            [&] { static_cast<void>(run(scene, {.folder = out, .resume = true})); });
        std::ofstream(file, std::ios::binary) << good;
        return error;
    };
    pent::test::expect_contains(resume_with(out / "journal.txt", "scalar", "avx512"),
                                {"journal.txt:1: ", "checksum"});
    pent::test::expect_contains(
        resume_with(out / "frames/box_000001.pent", "comment time 0.0", "comment time 0.1"),
        {"box_000001.pent", "header", "checksum"});
    pent::test::expect_contains(
        resume_with(out / "frames/box_000001.pent", "property double vx", "property double ux"),
        {"box_000001.pent", "header", "checksum"});
    EXPECT_EQ(run(scene, {.folder = out, .resume = true}).isa, "scalar");
}

// As version 0.1.0 left it: no list, no journal, and checkpoints in files of their own; its report
// lost the steps of its last seconds.
TEST(Run, ResumesARunOfVersion010ToTheSameBytes) {
    const TempFolder folder;
    Scene scene = falling_bar(folder, 3);
    scene.solver.integrator = Integrator::Bdf2;
    scene.sleep = Sleep{};
    const fs::path out = folder / "run";
    static_cast<void>(run(scene, {.folder = out}));
    static_cast<void>(run(scene, {.folder = folder / "whole"}));
    const StateBlocks blocks = read_checkpoint(out / "checkpoint/000003.state", 3, 6);
    auto before = read_frame<4>(out / "frames/box_000003.pent");
    const auto count = static_cast<std::size_t>(before.positions.size());
    for (auto* values : {&before.positions, &before.velocities}) {
        const bool is_first = values == &before.positions;
        const std::vector<double> numbers = blocks.get<double>(
            is_first ? "previous positions/box" : "previous velocities/box", count);
        *values = Eigen::Map<const Positions<4>>(numbers.data(), 4, values->cols());
    }
    fs::remove_all(out / "checkpoint");
    fs::create_directory(out / "checkpoint");
    write_frame(out / "checkpoint/box_000003.pent", before);
    std::ofstream(out / "checkpoint/rest_000003.json")
        << R"({"box": {"is_asleep": false, "quiet_steps": 0}})";
    fs::remove(out / "journal.txt");
    fs::remove(out / "written.txt");
    auto report = nlohmann::json::parse(read_text(out / "report.json"));
    report["verdict"] = "running";
    report["frames"].erase(3);
    report["steps"].erase(5);
    report["steps"].erase(4);
    std::ofstream(out / "report.json") << report.dump(1);
    scene.frames = 5;
    const RunReport resumed = run(scene, {.folder = out, .resume = true});
    EXPECT_EQ(resumed.frames.size(), 6U);
    EXPECT_EQ(resumed.steps.size(), 8U);  // of 10
    ASSERT_EQ(resumed.parts.size(), 2U);
    EXPECT_EQ(resumed.parts[0].verdict, "died");
    static_cast<void>(run(scene, {.folder = folder / "whole", .resume = true}));
    EXPECT_EQ(read_text(folder / "whole/frames/box_000005.pent"),
              read_text(out / "frames/box_000005.pent"));
    // From here on it is a run like any other.
    static_cast<void>(run(scene, {.folder = out, .force = true}));
    EXPECT_FALSE(fs::exists(out / "checkpoint/rest_000003.json"));
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
    ASSERT_EQ(report.warnings.size(), 2U);
    pent::test::expect_contains(report.warnings[0], {"mean surface edge"});
    pent::test::expect_contains(report.warnings[1],
                                {"[contact] distance = 0.2 m", "a tenth of \"box\"", "scale"});
    EXPECT_EQ(told, report.warnings);
    pent::test::expect_contains(read_text(folder / "run/report.json"), {"mean surface edge"});
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
    scene.contact = Contact{};
    pent::test::expect_contains(
        pent::test::error_of([&] { static_cast<void>(run(scene, {.folder = folder / "touch"})); }),
        {"bar.pent", "contact needs a closed surface"});
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
}  // namespace pent::runs
