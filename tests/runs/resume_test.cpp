#include "falling_bar.h"
#include "old_report.h"
#include "record/checkpoint_file.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/error.h>
#include <pent/pent_file.h>
#include <pent/runs/run.h>
#include <pent/runs/scene_file.h>
#include <pent/simulator/words.h>

#include <gtest/gtest.h>

#include <fstream>
#include <map>

namespace pent::runs {
namespace {

using namespace simulator;

namespace fs = std::filesystem;
using pent::test::TempFolder;
using test::bytes_of;
using test::falling_bar;

// One may work in the folder of a run: more frames, in its own scene file, with a comment.
TEST(Resume, LeavesTheSceneFileThatItReadsAsItIs) {
    const TempFolder folder;
    static_cast<void>(run(falling_bar(folder, 1), {.folder = folder / "run"}));
    const fs::path file = folder / "run/scene.toml";
    std::string text = bytes_of(file);
    text.replace(text.find("frames = 1"), 10, "frames = 2  # mine");
    std::ofstream(file) << text;
    static_cast<void>(
        run(read_scene(file), {.folder = folder / "run", .scene_file = file, .resume = true}));
    EXPECT_EQ(bytes_of(file), text);
    EXPECT_TRUE(fs::exists(folder / "run/frames/box_000002.pent"));
}

// Its copy of the scene names the mesh as seen from where it was.
TEST(Resume, OfAFolderThatWasMovedSaysWhichMeshIsMissingAndGoesOnWithIt) {
    const TempFolder folder;
    fs::create_directories(folder / "there/project");
    const Scene scene = falling_bar(folder, 2);
    static_cast<void>(run(scene, {.folder = folder / "whole"}));
    Scene part = scene;
    part.frames = 1;
    static_cast<void>(run(part, {.folder = folder / "run"}));
    fs::rename(folder / "run", folder / "there/project/run");
    const fs::path file = folder / "there/project/run/scene.toml";
    const auto resume = [&] {
        Scene moved = read_scene(file);
        moved.frames = 2;
        return run(moved, {.folder = file.parent_path(), .scene_file = file, .resume = true});
    };
    const std::string mesh = (folder / "there/project/bar.pent").string();
    pent::test::expect_contains(pent::test::error_of([&] { static_cast<void>(resume()); }),
                                {"run/scene.toml:", mesh + ": cannot be read: No such file",
                                 "the mesh of \"box\": put it there, or let `mesh` name it"});
    fs::rename(folder / "bar.pent", mesh);
    EXPECT_EQ(resume().verdict, RunVerdict::Finished);
    const std::string last = "frames/box_000002.pent";
    EXPECT_EQ(bytes_of(file.parent_path() / last), bytes_of(folder / "whole" / last));
}

class ResumeIntegrators : public testing::TestWithParam<Integrator> {};
INSTANTIATE_TEST_SUITE_P(All,
                         ResumeIntegrators,
                         testing::Values(Integrator::LinearEuler,
                                         Integrator::NewtonEuler,
                                         Integrator::Bdf2));

// With loads that change while the run is stopped, and all that frames may have of vertices.
TEST_P(ResumeIntegrators, StopWhenAskedAndResumeToTheSameBytes) {
    const TempFolder folder;
    Scene scene = falling_bar(folder, 4);
    scene.solver.integrator = GetParam();
    const HalfSpaceSelection right{.normal = -Eigen::Vector4d::UnitX(), .offset = -0.749};
    scene.loads = {{.body = "box",
                    .select = {right},
                    .force = Eigen::Vector4d(0, 0, 2, 5),
                    .pressure = 1e3,
                    .keyframes = {{0, 0}, {0.08, 1}, {0.12, 0.3}}}};
    scene.output.vertex = values<VertexQuantity>();
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
    const Frame<4> last = read_frame<4>(folder / "whole/frames/box_000004.pent");
    EXPECT_EQ(last.fields.size(), 2U);
    EXPECT_GT(find_field(last, "reaction")->values.norm(), 0);
    EXPECT_GT(find_field(last, "energy_density")->values.norm(), 0);
    EXPECT_EQ(last.contact_forces.cols(), last.positions.cols());
    for (const char* frame : {"box_000003.pent", "box_000004.pent"}) {
        EXPECT_EQ(bytes_of(folder / "whole/frames" / frame),
                  bytes_of(folder / "cut/frames" / frame));
    }
}

// Two at once would mix their frames.
TEST(Resume, IsRefusedWhileAnotherProgramWritesToTheFolder) {
    const TempFolder folder;
    const Scene scene = falling_bar(folder, 2);
    int frames = 0;
    const auto resume_too = [&](const FrameReport& /*frame*/, const StepReport& /*step*/) {
        ++frames;
        pent::test::expect_contains(
            pent::test::error_of(
                [&] { static_cast<void>(run(scene, {.folder = folder / "run", .resume = true})); }),
            {"another program is writing to this folder"});
    };
    const RunReport report =
        run(scene, {.folder = folder / "run"}, {.should_stop = nullptr, .on_frame = resume_too});
    EXPECT_EQ(frames, 3);
    EXPECT_EQ(report.verdict, RunVerdict::Finished);
    static_cast<void>(run(scene, {.folder = folder / "once"}));
    EXPECT_EQ(bytes_of(folder / "run/frames/box_000002.pent"),
              bytes_of(folder / "once/frames/box_000002.pent"));
}

TEST(Resume, RemovesWhatAKilledRunLeftHalfWritten) {
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

// As on a full disk: a folder stands in the way of one of the files of frame 3.
TEST(Resume, WritesAllFilesOfAFrameOfWhichOneCouldNotBeWritten) {
    const TempFolder folder;
    Scene scene = falling_bar(folder, 5);
    scene.solver.integrator = Integrator::Bdf2;  // which has checkpoints
    Motion rising = simulator::test::still(4);
    rising.translate[1] = 0.1;
    scene.obstacles = {
        {.shape = HalfSpaceObstacle{.normal = Eigen::Vector4d::UnitY()}, .motion = {rising}}};
    scene.output.contact_pairs = true;
    static_cast<void>(run(scene, {.folder = folder / "whole"}));
    const auto files_of = [&](const std::string& name) {
        std::map<std::string, std::string> files;
        for (const auto& entry : fs::recursive_directory_iterator(folder / name)) {
            const std::string file = fs::relative(entry.path(), folder / name).string();
            if (entry.is_regular_file() && entry.path().parent_path() != folder / name) {
                files[file] = bytes_of(entry.path());
            }
        }
        return files;
    };
    const auto whole = files_of("whole");
    for (const std::string file : {"checkpoint/000003.state", "obstacles/000003.json",
                                   "contacts/000003.csv", "frames/box_000003.pent"}) {
        EXPECT_EQ(whole.contains(file), file[1] != 'h') << file;  // two checkpoints are kept
        const fs::path in_the_way = folder / "cut" / file;
        const auto stand_in_the_way = [&](const FrameReport& frame, const StepReport& /*step*/) {
            if (frame.frame == 2) {
                fs::create_directories(in_the_way / "something");
            }
        };
        EXPECT_ANY_THROW(
            static_cast<void>(run(scene, {.folder = folder / "cut", .force = true},
                                  {.should_stop = nullptr, .on_frame = stand_in_the_way})));
        fs::remove_all(in_the_way);
        static_cast<void>(run(scene, {.folder = folder / "cut", .resume = true}));
        EXPECT_EQ(files_of("cut"), whole) << file;
    }
}

TEST(Resume, SaysWhatToDoWhereARunWasKilledBeforeItsStartWasWritten) {
    const TempFolder folder;
    const Scene scene = falling_bar(folder, 1);
    static_cast<void>(run(scene, {.folder = folder / "run"}));
    const fs::path journal = folder / "run/journal.txt";
    std::string text = bytes_of(journal);
    std::ofstream(journal) << text.substr(0, text.find('\n') + 1);  // the part alone
    for (const char* file :
         {"frames/box_000001.pent", "frames/box_000000.pent", "meshes/box.pent"}) {
        fs::remove(folder / "run" / file);
    }
    EXPECT_EQ(pent::test::error_of([&] {
                  static_cast<void>(run(scene, {.folder = folder / "run", .resume = true}));
              }),
              (folder / "run").string()
                  + ": holds no whole frame to resume from; use --force to start again");
}

// BDF2 needs the step before, and that is kept for the last two frames only.
TEST(Resume, RefusesAFrameWhoseStepBeforeIsNotKept) {
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
TEST(Resume, FindsTheRunWhereverItWasMovedOrCopiedTo) {
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
    EXPECT_EQ(bytes_of(folder / "whole/frames/box_000003.pent"),
              bytes_of(folder / "elsewhere/deep/run/frames/box_000003.pent"));
}

// Labels decide what is held and how unknowns are numbered: positions and cells alone are not the
// mesh.
TEST(Resume, RefusesAMeshOfOtherLabels) {
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
TEST(Resume, TellsOfAllPartsHoweverTheyEnded) {
    const TempFolder folder;
    Scene scene = falling_bar(folder, 2);
    const fs::path out = folder / "run";
    static_cast<void>(run(scene, {.folder = out}));
    scene.frames = 4;
    static_cast<void>(run(scene, {.folder = out, .resume = true}));
    // What a kill leaves: no end, half a line, and a report that is seconds old.
    std::string journal = bytes_of(out / "journal.txt");
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
              "the run had died (it was killed or crashed) after frame 4; it goes on from there");
    ASSERT_EQ(report.frames.size(), 6U);
    ASSERT_EQ(report.steps.size(), 10U);
    for (std::size_t i = 0; i < 10; ++i) {
        EXPECT_EQ(report.steps[i].step, i + 1);
    }
    ASSERT_EQ(report.parts.size(), 3U);
    EXPECT_EQ(report.parts[0].verdict, RunVerdict::Finished);
    EXPECT_EQ(report.parts[1].verdict, RunVerdict::Died);
    EXPECT_EQ(report.parts[1].first_frame, 2);
    EXPECT_EQ(report.parts[1].last_frame, 4);
    EXPECT_GT(report.parts[1].seconds, 0);
    EXPECT_EQ(report.parts[2].verdict, RunVerdict::Finished);
    EXPECT_EQ(report.parts[2].first_frame, 4);
    const std::string text = bytes_of(out / "report.json");
    pent::test::expect_contains(text, {"\"died\"", "\"step\": 10"});
}

// What is believed on the way back in has a checksum: the journal, line by line, which has the
// instruction set; and the headers of frames.
TEST(Resume, RefusesAJournalOrAFrameThatWasChanged) {
    const TempFolder folder;
    Scene scene = falling_bar(folder, 1);
    const fs::path out = folder / "run";
    static_cast<void>(run(scene, {.folder = out, .isa = "scalar"}));
    scene.frames = 2;
    const auto resume_with = [&](const fs::path& file, const std::string& from,
                                 const std::string& to) {
        const std::string good = bytes_of(file);
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
    EXPECT_EQ(run(scene, {.folder = out, .resume = true}).parts.back().isa, "scalar");
}

// As version 0.1.0 left it: no list, no journal, and checkpoints in files of their own; its report
// lost the steps of its last seconds.
TEST(Resume, GoesOnWithARunOfVersion010ToTheSameBytes) {
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
    RunReport known = read_report(out / "report.json");
    known.verdict = RunVerdict::Running;
    known.frames.pop_back();
    known.steps.resize(4);
    std::ofstream(out / "report.json") << test::report_text_of_version_010(known);
    scene.frames = 5;
    const RunReport resumed = run(scene, {.folder = out, .resume = true});
    EXPECT_EQ(resumed.frames.size(), 6U);
    EXPECT_EQ(resumed.steps.size(), 8U);  // of 10
    ASSERT_EQ(resumed.parts.size(), 2U);
    EXPECT_EQ(resumed.parts[0].verdict, RunVerdict::Died);
    static_cast<void>(run(scene, {.folder = folder / "whole", .resume = true}));
    EXPECT_EQ(bytes_of(folder / "whole/frames/box_000005.pent"),
              bytes_of(out / "frames/box_000005.pent"));
    // From here on it is a run like any other.
    static_cast<void>(run(scene, {.folder = out, .force = true}));
    EXPECT_FALSE(fs::exists(out / "checkpoint/rest_000003.json"));
}

TEST(Resume, RefusesAnotherScene) {
    const TempFolder folder;
    Scene scene = falling_bar(folder, 1);
    static_cast<void>(run(scene, {.folder = folder / "run"}));
    scene.gravity[1] = 3;
    EXPECT_THROW(static_cast<void>(run(scene, {.folder = folder / "run", .resume = true})), Error);
    EXPECT_THROW(static_cast<void>(run(scene, {.folder = folder / "none", .resume = true})), Error);
}

// The stiffness to which a barrier has adapted is in no file of that version.
TEST(Resume, RefusesARunOfVersion010WithABarrier) {
    const TempFolder folder;
    Scene scene = falling_bar(folder, 2);
    scene.solver.integrator = Integrator::NewtonEuler;
    scene.contact = ContactSettings{.model = ContactModel::Barrier, .distance = 0.01};
    const fs::path out = folder / "run";
    const RunReport known = run(scene, {.folder = out});
    for (const char* newer : {"checkpoint", "journal.txt", "written.txt"}) {
        fs::remove_all(out / newer);
    }
    std::ofstream(out / "report.json") << test::report_text_of_version_010(known);
    scene.frames = 3;
    pent::test::expect_contains(pent::test::error_of([&] {
                                    static_cast<void>(run(scene, {.folder = out, .resume = true}));
                                }),
                                {"barrier", "--force"});
}

}  // namespace
}  // namespace pent::runs
