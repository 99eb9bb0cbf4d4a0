#include "run_program.h"
#include "support/kuhn_box.h"
#include "support/messages.h"

#include <pent/pent_file.h>

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sys/stat.h>
#include <unistd.h>

namespace pent {
namespace {

namespace fs = std::filesystem;
using test::expect_contains;
using test::expect_one_error_line;
using test::interrupt_at;
using test::Outcome;
using test::run_program;
using test::text_of;

constexpr int kFrames = 30;

// A bar that swings, under the integrator that needs most to go on: it looks back two steps.
class Faults : public testing::Test {
protected:
    Faults() {
        write_mesh(folder_ / "bar.pent", test::kuhn_box<4>({6, 2, 2, 2}, {1.5, 0.5, 0.5, 0.5}));
        write_scene(kFrames);
    }

    void write_scene(int frames, const std::string& more = "") const {
        std::ofstream(folder_ / "bar.toml") << "[scene]\nframes = " << frames << R"(
gravity = [0, -9.8, 0, 0]
steps_per_frame = 2

[[body]]
name = "bar"
mesh = "bar.pent"

[[constraint]]
body = "bar"
select = { half_space = { normal = [1, 0, 0, 0], offset = 1e-6 } }

[solver]
integrator = "bdf2"
)" << more;
    }

    // As the shell runs it, behind `before`.
    [[nodiscard]] Outcome simulate(const std::string& run,
                                   const std::string& options = "",
                                   const std::string& before = "") const {
        return run_program(
            "pent-sim " + path("bar.toml") + " -o " + path(run) + " --threads 1 " + options,
            before);
    }

    [[nodiscard]] std::string frame(const std::string& run, int number) const {
        const std::string digits = std::to_string(number);
        return path(run + "/frames/bar_" + std::string(6 - digits.size(), '0') + digits + ".pent");
    }

    [[nodiscard]] int count_frames(const std::string& run) const {
        int count = 0;
        while (fs::exists(frame(run, count))) {
            ++count;
        }
        return count;
    }

    void expect_same_frames(const std::string& a, const std::string& b, int last = kFrames) const {
        for (int i = 0; i <= last; ++i) {
            ASSERT_FALSE(text_of(frame(a, i)).empty()) << i;
            ASSERT_EQ(text_of(frame(a, i)), text_of(frame(b, i))) << i;
        }
    }

    void expect_no_temporary_files(const std::string& run) const {
        for (const auto& entry : fs::recursive_directory_iterator(folder_ / run)) {
            EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
        }
    }

    [[nodiscard]] std::string verdict(const std::string& run) const {
        return nlohmann::json::parse(text_of(folder_ / (run + "/report.json"))).at("verdict");
    }

    // A run that was stopped in the middle: a shorter one of the same scene.
    void make_half() {
        write_scene(kFrames / 2);
        ASSERT_EQ(simulate("run").exit_code, 0);
        write_scene(kFrames);
    }

    void flip_a_byte(const std::string& file, std::streamoff from_end) const {
        std::fstream bytes(file, std::ios::binary | std::ios::in | std::ios::out);
        bytes.seekg(-from_end, std::ios::end);
        const int byte = bytes.get();
        bytes.seekp(-from_end, std::ios::end);
        bytes.put(static_cast<char>(byte ^ 0x10));
    }

    [[nodiscard]] std::string path(const std::string& name) const {
        return (folder_ / name).string();
    }

    test::TempFolder folder_;
};

// Killed again and again at moments drawn from the time that some frames take. Moments differ from
// one repetition to the next with --gtest_repeat=N --gtest_shuffle: scripts/faults.sh.
TEST_F(Faults, RunKilledAtAnyMomentGoesOnToTheSameBytesAndLosesNoFrame) {
    const auto start = std::chrono::steady_clock::now();
    ASSERT_EQ(simulate("whole").exit_code, 0);
    const std::chrono::duration<double> whole = std::chrono::steady_clock::now() - start;
    std::mt19937 random(static_cast<unsigned>(testing::UnitTest::GetInstance()->random_seed()));
    std::uniform_real_distribution<double> share(0.05, 0.8);
    write_scene(1000 * kFrames);  // far longer than it gets
    int frames = 0;
    for (int kill = 0; kill < 5; ++kill) {
        // Else `timeout` kills its whole group, itself with it, and is done before the run is dead,
        // which holds the lock of its folder until then.
        const std::string timeout = std::string(test::kUncounted) + "timeout --foreground -s KILL "
                                    + std::to_string(share(random) * whole.count());
        // A run killed before its first frame has nothing to resume and is started again.
        const Outcome outcome = simulate("run", frames > 0 ? "--resume" : "--force", timeout);
        ASSERT_EQ(outcome.exit_code, 128 + SIGKILL) << outcome.err;
        const int now = count_frames("run");
        ASSERT_GE(now, frames);
        frames = now;
    }
    write_scene(frames + 3);
    const Outcome last = simulate("run", frames > 0 ? "--resume" : "--force");
    ASSERT_EQ(last.exit_code, 0) << last.err;
    ASSERT_EQ(simulate("whole", "--force").exit_code, 0);
    expect_same_frames("whole", "run", frames + 3);
    expect_no_temporary_files("run");
    EXPECT_EQ(verdict("run"), "finished");
}

TEST_F(Faults, InterruptEndsAtTheNextStepWithAVerdictAndCanBeResumed) {
    write_scene(2000);  // far longer than it gets
    const Outcome stopped = simulate("run", "", interrupt_at(frame("run", 3)));
    EXPECT_EQ(stopped.exit_code, 3) << stopped.err;
    EXPECT_TRUE(stopped.err.empty()) << stopped.err;
    expect_contains(stopped.out, {"stopped"});
    EXPECT_EQ(verdict("run"), "stopped");
    expect_no_temporary_files("run");
    const int frames = count_frames("run");
    ASSERT_GT(frames, 0);
    write_scene(frames + 3);
    ASSERT_EQ(simulate("run", "--resume").exit_code, 0);
    ASSERT_EQ(simulate("whole").exit_code, 0);
    expect_same_frames("whole", "run", frames + 3);
}

// A limit on the size of files stands for a full disk: the journal grows beyond it in mid-run.
TEST_F(Faults, FullDiskIsOneLineAndTheRunGoesOnWhenThereIsRoom) {
    const Outcome full = simulate("run", "", test::full_disk(40000));
    EXPECT_EQ(full.exit_code, 1);
    expect_one_error_line(full, "pent-sim");
    expect_contains(full.err, {"journal.txt", "cannot be written"});
    expect_no_temporary_files("run");
    EXPECT_LT(count_frames("run"), kFrames);
    ASSERT_EQ(simulate("run", "--resume").exit_code, 0);
    ASSERT_EQ(simulate("whole").exit_code, 0);
    expect_same_frames("whole", "run");
}

// A file system of 400 KiB, which only root can make: it fills up in mid-run.
TEST_F(Faults, FullFileSystemInMidRunLosesNoFrame) {
    fs::create_directory(folder_ / "small");
    const std::string small = path("small");
    // NOLINTNEXTLINE(cert-env33-c): a test of what a user may meet
    if (std::system(("mount -t tmpfs -o size=400k tmpfs " + small + " 2>/dev/null").c_str()) != 0) {
        GTEST_SKIP() << "needs the right to mount";
    }
    const Outcome full = simulate("small/run");
    const int frames = count_frames("small/run");
    fs::copy(folder_ / "small/run", folder_ / "kept", fs::copy_options::recursive);
    // NOLINTNEXTLINE(cert-env33-c)
    EXPECT_EQ(std::system(("umount " + small).c_str()), 0);
    EXPECT_EQ(full.exit_code, 1);
    expect_one_error_line(full, "pent-sim");
    expect_contains(full.err, {"cannot be written", "No space left"});
    EXPECT_GT(frames, 3);
    EXPECT_LT(frames, kFrames);
    expect_no_temporary_files("kept");
    fs::rename(folder_ / "kept", folder_ / "small/run");  // where there is room now
    ASSERT_EQ(simulate("small/run", "--resume").exit_code, 0);
    ASSERT_EQ(simulate("whole").exit_code, 0);
    expect_same_frames("whole", "small/run");
}

// Root may write anywhere: then another user runs a copy of the program.
TEST_F(Faults, FolderWithoutPermissionIsOneLineThatNamesIt) {
    fs::create_directory(folder_ / "closed");
    ASSERT_EQ(::chmod(path("closed").c_str(), 0555), 0);
    ASSERT_EQ(::chmod(folder_.path().c_str(), 0755), 0);
    std::string as_nobody;
    if (::geteuid() == 0) {
        fs::copy_file(PENT_BIN "/pent-sim", folder_ / "pent-sim");
        as_nobody = "run() { shift; setpriv --reuid=65534 --regid=65534 --clear-groups "
                    + path("pent-sim") + " \"$@\"; }; run";
    }
    const Outcome outcome = simulate("closed/run", "", as_nobody);
    EXPECT_EQ(outcome.exit_code, 1);
    expect_one_error_line(outcome, "pent-sim");
    expect_contains(outcome.err, {path("closed/run"), "ermission denied"});
}

TEST_F(Faults, MoreFramesAreAnAllowedChange) {
    make_half();
    ASSERT_EQ(simulate("run", "--resume").exit_code, 0);
    ASSERT_EQ(simulate("whole").exit_code, 0);
    expect_same_frames("whole", "run");
}

TEST_F(Faults, AnyOtherChangeOfTheSceneIsRefused) {
    make_half();
    const std::string before = text_of(folder_ / "run/report.json");
    write_scene(kFrames, "tolerance = 1e-5\n");
    const Outcome outcome = simulate("run", "--resume");
    EXPECT_EQ(outcome.exit_code, 1);
    expect_one_error_line(outcome, "pent-sim");
    expect_contains(outcome.err, {"run/scene.toml", "tolerance", "--force"});
    EXPECT_EQ(text_of(folder_ / "run/report.json"), before);
    EXPECT_EQ(count_frames("run"), kFrames / 2 + 1);
}

// As if an older program, which did not know the key, had begun the run.
TEST_F(Faults, KeyThatTheSceneOfTheRunLacksHasItsDefault) {
    make_half();
    std::string scene = text_of(folder_ / "run/scene.toml");
    const std::string key = "elements = \"linear\"\n";
    ASSERT_NE(scene.find(key), std::string::npos);
    scene.erase(scene.find(key), key.size());
    std::ofstream(folder_ / "run/scene.toml") << scene;
    ASSERT_EQ(simulate("run", "--resume").exit_code, 0);
    ASSERT_EQ(simulate("whole").exit_code, 0);
    expect_same_frames("whole", "run");
    EXPECT_EQ(text_of(folder_ / "run/scene.toml"), text_of(folder_ / "whole/scene.toml"));
}

TEST_F(Faults, DamagedSceneOfTheRunIsNamed) {
    make_half();
    std::ofstream(folder_ / "run/scene.toml") << "[scene\n";
    const Outcome outcome = simulate("run", "--resume");
    EXPECT_EQ(outcome.exit_code, 1);
    expect_one_error_line(outcome, "pent-sim");
    expect_contains(outcome.err, {"run/scene.toml:1:", "--force"});
}

TEST_F(Faults, DamagedFrameIsNamedAndItsRemovalLetsTheRunGoOn) {
    make_half();
    const std::string last = frame("run", kFrames / 2);
    flip_a_byte(last, 100);
    const Outcome outcome = simulate("run", "--resume");
    EXPECT_EQ(outcome.exit_code, 1);
    expect_one_error_line(outcome, "pent-sim");
    expect_contains(outcome.err, {last, "checksum", "remove"});
    fs::remove(last);
    ASSERT_EQ(simulate("run", "--resume").exit_code, 0);
    ASSERT_EQ(simulate("whole").exit_code, 0);
    expect_same_frames("whole", "run");
}

TEST_F(Faults, RunWithoutAnyFrameHasNothingToGoOnFrom) {
    make_half();
    for (int i = 0; i <= kFrames / 2; ++i) {
        ASSERT_TRUE(fs::remove(frame("run", i)));
    }
    const Outcome outcome = simulate("run", "--resume");
    EXPECT_EQ(outcome.exit_code, 1);
    expect_one_error_line(outcome, "pent-sim");
    expect_contains(outcome.err, {path("run"), "no whole frame to resume from", "--force"});
}

TEST_F(Faults, FrameOfAnotherMomentOrMeshIsRefused) {
    make_half();
    const std::string last = frame("run", kFrames / 2);
    const std::string own = text_of(last);
    fs::copy_file(frame("run", 3), last, fs::copy_options::overwrite_existing);
    const Outcome other_moment = simulate("run", "--resume");
    EXPECT_EQ(other_moment.exit_code, 1);
    expect_contains(other_moment.err, {last, "frame 3"});
    Frame<4> state = (std::ofstream(last, std::ios::binary) << own, read_frame<4>(last));
    state.mesh_crc ^= 1;
    write_frame(last, state);
    const Outcome other_mesh = simulate("run", "--resume");
    EXPECT_EQ(other_mesh.exit_code, 1);
    expect_contains(other_mesh.err, {last, "another mesh"});
}

TEST_F(Faults, ChangedMeshIsRefused) {
    make_half();
    SimplexMesh<4> mesh = read_mesh<4>(folder_ / "bar.pent").mesh;
    mesh.positions.row(1) *= 1.01;  // as many vertices, another shape
    write_mesh(folder_ / "bar.pent", mesh);
    const Outcome outcome = simulate("run", "--resume");
    EXPECT_EQ(outcome.exit_code, 1);
    expect_one_error_line(outcome, "pent-sim");
    expect_contains(outcome.err, {"bar.pent", "mesh"});
    EXPECT_EQ(count_frames("run"), kFrames / 2 + 1);
}

TEST_F(Faults, DamagedMeshInTheRunFolderIsNamed) {
    make_half();
    flip_a_byte(path("run/meshes/bar.pent"), 100);
    const Outcome outcome = simulate("run", "--resume");
    EXPECT_EQ(outcome.exit_code, 1);
    expect_contains(outcome.err, {"run/meshes/bar.pent", "checksum"});
}

TEST_F(Faults, StartThatCrossesABarrierLeavesTheCellsThatAreInTheWay) {
    write_scene(kFrames, R"(
[[body]]
name = "other"
mesh = "bar.pent"
place = { translate = [0.1, 0.3, 0.02, 0.03] }

[contact]
model = "barrier"
)");
    const Outcome outcome = simulate("run");
    EXPECT_EQ(outcome.exit_code, 1);
    expect_one_error_line(outcome, "pent-sim");
    expect_contains(outcome.err, {"'bar'", "'other'", "run-crossings.pent"});
    const SimplexMesh<4> offenders = read_mesh<4>(folder_ / "run-crossings.pent").mesh;
    const SimplexMesh<4> bar = read_mesh<4>(folder_ / "bar.pent").mesh;
    EXPECT_GT(offenders.cell_count(), 0);
    EXPECT_LT(offenders.cell_count(), 2 * bar.cell_count());
}

}  // namespace
}  // namespace pent
