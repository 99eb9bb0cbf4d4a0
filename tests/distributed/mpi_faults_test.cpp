#include "mpi_scenes.h"
#include "support/messages.h"

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

    // What to put before a command that has a run, so that something is done to processes of it
    // once there are frames. In the text of what is done $1 is one of them.
    [[nodiscard]] std::string meddle(const std::string& run,
                                     const std::string& which,
                                     const std::string& action) const {
        return "act() { " + action + "; }; meddle() { \"$@\" & while [ ! -e " + frame(run, "bar", 1)
               + " ] && kill -0 $!; do sleep 0.05; done; " + "for one in $(pgrep " + which
               + " -f 'pent-sim-mpi.*" + path(run) + "'); do act $one; done; wait $!; }; meddle "
               + mpirun(3);
    }

    // The long run, by three ranks, one of which gets a signal.
    [[nodiscard]] Outcome signal_one(const std::string& signal) const {
        write_long();
        return run_program(
            "pent-sim-mpi " + path("long.toml") + " -o " + path("run") + " --threads 1",
            meddle("run", "-n", "kill -" + signal + " $1"));
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

// Each rank writes its slab; where one cannot, nothing is left of the frame. MPI has files of its
// own, so that the limit comes later.
TEST_F(MpiFaults, AFullDiskEndsTheRunOnAllRanks) {
    write_long();
    expect_refused(
        run_program("pent-sim-mpi " + path("long.toml") + " -o " + path("run") + " --threads 1",
                    meddle("run", "", "prlimit --fsize=2000 --pid $1")),
        {"run/", "cannot be written"});
    expect_contains(simulate(2, "bar", "run").err, {"holds a run"});
}

TEST_F(MpiFaults, AFullDiskOfOneRankEndsTheRunOnAllRanks) {
    write_long();
    expect_refused(
        run_program("pent-sim-mpi " + path("long.toml") + " -o " + path("run") + " --threads 1",
                    meddle("run", "-n", "prlimit --fsize=2000 --pid $1")),
        {"run/frames/bar_", "cannot be written", "file size"});
    int frames = 0;
    for (const auto& entry : std::filesystem::directory_iterator(path("run/frames"))) {
        static_cast<void>(read_frame<4>(entry.path()));  // whole, or it throws
        ++frames;
    }
    EXPECT_GE(frames, 2);
}

TEST_F(MpiFaults, ARunThatIsThereIsNotReplaced) {
    ASSERT_EQ(simulate(2, "bar", "run").exit_code, 0);
    expect_refused(simulate(2, "bar", "run"), {"holds a run", "--resume"});
}

TEST_F(MpiFaults, AKilledRankEndsTheRunWhichGoesOnLater) {
    const Outcome killed = signal_one("KILL");
    EXPECT_NE(killed.exit_code, 0);
    EXPECT_NE(killed.exit_code, 124) << "it hung";
    int last = 1;
    while (std::filesystem::exists(frame("run", "bar", last + 1))) {
        ++last;
    }
    std::string text = kBar;
    text.replace(text.find("frames = 4"), 10, "frames = " + std::to_string(last + 1));
    write("long", text);
    const Outcome resumed = simulate(2, "long", "run", "--resume");
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    expect_contains(resumed.out, {"had died", "run by 3 ranks and goes on by 2 ranks"});
}

TEST_F(MpiFaults, ASignalToOneRankStopsAllInOrder) {
    const Outcome stopped = signal_one("TERM");
    EXPECT_EQ(stopped.exit_code, 3) << stopped.err;
    expect_contains(stopped.out, {"stopped"});
    EXPECT_EQ(report("run").verdict, runs::RunVerdict::Stopped);
}

}  // namespace
}  // namespace pent
