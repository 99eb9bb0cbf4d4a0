#include "mpi_scenes.h"
#include "support/messages.h"

#include <algorithm>

namespace pent {
namespace {

using test::expect_contains;
using test::mpirun;
using test::Outcome;
using test::run_program;

class MpiFaults : public test::MpiScenes {
protected:
    // One line of ours on stderr, however many ranks; mpirun may say more.
    static void expect_refused(const Outcome& outcome, std::initializer_list<std::string> parts) {
        EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
        const std::string name = "pent-sim-mpi: ";
        EXPECT_NE(outcome.err.find(name), std::string::npos) << outcome.err;
        EXPECT_EQ(outcome.err.find(name), outcome.err.rfind(name)) << outcome.err;
        expect_contains(outcome.err, parts);
    }

    // A long run, so that something can happen in it.
    void write_long() const {
        std::string text = kBar;
        text.replace(text.find("frames = 4"), 10, "frames = 2000");
        write("long", text);
    }

    // Waits for a frame of the run, then sends a signal to one rank.
    [[nodiscard]] std::string signal_one(const std::string& run, const std::string& signal) const {
        return "signal_one() { \"$@\" & while [ ! -e " + frame(run, "bar", 3)
               + " ] && kill -0 $!; do sleep 0.05; done; " + "kill -" + signal
               + " $(pgrep -n -f 'pent-sim-mpi.*" + path(run) + "'); wait $!; }; signal_one "
               + mpirun(3);
    }
};

TEST_F(MpiFaults, OfTheCommandLineAreToldOnce) {
    const Outcome wrong = run_program("pent-sim-mpi --layer", mpirun(3));
    EXPECT_EQ(wrong.exit_code, 2) << wrong.err;
    EXPECT_EQ(wrong.err.find("pent-sim-mpi: "), wrong.err.rfind("pent-sim-mpi: ")) << wrong.err;
}

TEST_F(MpiFaults, MoreRanksThanColumnsAreRefused) {
    SimplexMesh<3> small = test::kuhn_box<3>({1, 1, 1}, {1, 1, 1});
    small.columns = {0, 1, 0, 1, 0, 1, 0, 1};
    small.layers = {0, 0, 1, 1, 2, 2, 3, 3};
    static_cast<void>(write_mesh(folder_ / "small.pent", small));
    write("small",
          "[scene]\ndimension = 3\nframes = 1\n[[body]]\nname = \"a\"\nmesh = \"small.pent\"\n");
    expect_refused(simulate(3, "small", "run"), {"2 columns", "3 ranks", "start fewer"});
    EXPECT_EQ(simulate(2, "small", "run").exit_code, 0);
}

TEST_F(MpiFaults, ADirectSolveIsRefused) {
    write("direct", std::string(kBar) + "linear = \"direct\"\n");
    expect_refused(simulate(2, "direct", "run"), {"solver.linear", "\"cg\"", "pent-sim"});
    EXPECT_FALSE(std::filesystem::exists(path("run")));
}

TEST_F(MpiFaults, AnotherSceneOnOneRankIsRefused) {
    std::string other = kBar;
    other.replace(other.find("1e5"), 3, "2e5");
    write("other", other);
    const std::string program = PENT_BIN "/pent-sim-mpi --threads 1 ";
    expect_refused(
        run_program(
            "pent-sim-mpi --threads 1 " + path("other.toml") + " -o " + path("run"),
            mpirun(2) + " " + program + path("bar.toml") + " -o " + path("run") + " : -n 1"),
        {"rank 2 has another scene than rank 0", "same file"});
}

TEST_F(MpiFaults, AnotherMeshOnOneRankIsRefused) {
    std::filesystem::create_directory(folder_ / "disk");
    SimplexMesh<4> mesh = read_mesh<4>(folder_ / "bar.pent").mesh;
    mesh.positions(0, 0) -= 1e-3;
    static_cast<void>(write_mesh(folder_ / "disk" / "bar.pent", mesh));
    std::filesystem::copy(path("bar.toml"), folder_ / "disk" / "bar.toml");
    // Each in a folder of its own, so that the scenes are the same.
    const std::string program = PENT_BIN "/pent-sim-mpi --threads 1 bar.toml -o " + path("run");
    expect_refused(run_program("pent-sim-mpi --threads 1 bar.toml -o " + path("run"),
                               mpirun(1, "--wdir " + path("")) + " " + program + " : --wdir "
                                   + path("disk") + " -n 1"),
                   {"rank 1 has other meshes than rank 0", "same files"});
}

TEST_F(MpiFaults, AMeshThatOneRankCannotReadIsToldByItsName) {
    std::filesystem::create_directory(folder_ / "empty");
    std::filesystem::copy(path("bar.toml"), folder_ / "empty" / "bar.toml");
    const std::string program = PENT_BIN "/pent-sim-mpi --threads 1 bar.toml -o " + path("run");
    expect_refused(run_program("pent-sim-mpi --threads 1 bar.toml -o " + path("run"),
                               mpirun(1, "--wdir " + path("")) + " " + program + " : --wdir "
                                   + path("empty") + " -n 1"),
                   {"bar.pent", "No such file"});
}

// Rank 0 writes; the others have to hear of it.
TEST_F(MpiFaults, AFullDiskEndsTheRunOnAllRanks) {
    const std::string arguments = path("bar.toml") + " -o " + path("run") + " --threads 1";
    expect_refused(run_program("pent-sim-mpi " + arguments, mpirun(3) + " prlimit --fsize=20000"),
                   {"run/"});
    const Outcome again = simulate(3, "bar", "run", "--force");
    EXPECT_EQ(again.exit_code, 0) << again.err;
}

TEST_F(MpiFaults, ARunThatIsThereIsNotReplaced) {
    ASSERT_EQ(simulate(2, "bar", "run").exit_code, 0);
    expect_refused(simulate(2, "bar", "run"), {"holds a run", "--resume"});
}

TEST_F(MpiFaults, AKilledRankEndsTheRunWhichGoesOnLater) {
    write_long();
    const std::string arguments = path("long.toml") + " -o " + path("run") + " --threads 1";
    const Outcome killed = run_program("pent-sim-mpi " + arguments, signal_one("run", "KILL"));
    EXPECT_NE(killed.exit_code, 0);
    EXPECT_NE(killed.exit_code, 124) << "it hung";
    std::string text = kBar;
    text.replace(text.find("frames = 4"), 10, "frames = 6");
    write("long", text);
    std::filesystem::remove_all(folder_ / "half");
    const Outcome resumed = simulate(2, "long", "run", "--resume");
    // Either behind the frames that are there already, or with those that are missing.
    if (std::filesystem::exists(frame("run", "bar", 7))) {
        EXPECT_EQ(resumed.exit_code, 1);
    } else {
        EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
        expect_contains(resumed.out, {"had died"});
    }
}

TEST_F(MpiFaults, ASignalToOneRankStopsAllInOrder) {
    write_long();
    const std::string arguments = path("long.toml") + " -o " + path("run") + " --threads 1";
    const Outcome stopped = run_program("pent-sim-mpi " + arguments, signal_one("run", "TERM"));
    EXPECT_EQ(stopped.exit_code, 3) << stopped.err;
    expect_contains(stopped.out, {"stopped"});
    EXPECT_EQ(report("run").verdict, runs::RunVerdict::Stopped);
}

}  // namespace
}  // namespace pent
