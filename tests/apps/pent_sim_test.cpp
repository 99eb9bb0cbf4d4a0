#include "run_program.h"
#include "support/kuhn_box.h"
#include "support/messages.h"

#include <pent/pent_file.h>

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

// What pent-sim says of a run that ends, but not as one would wish.

namespace pent {
namespace {

using test::expect_contains;
using test::Outcome;

// Two cells in a row, both ends held, the right one pushed by `meters` along x within ten steps.
nlohmann::json push_through(double meters, const std::string& solver, Outcome& outcome) {
    const test::TempFolder folder;
    write_mesh(folder / "bar.pent", test::kuhn_box<3>({2, 1, 1}, {1, 0.5, 0.5}));
    std::ofstream(folder / "bar.toml") << R"([scene]
dimension = 3
frames = 10
frames_per_second = 10

[[body]]
name = "bar"
mesh = "bar.pent"

[[constraint]]
body = "bar"
select = { half_space = { normal = [1, 0, 0], offset = 1e-6 } }

[[constraint]]
body = "bar"
select = { half_space = { normal = [-1, 0, 0], offset = -0.999999 } }
motion = { translate = [)" << meters << R"(, 0, 0] }

[solver]
integrator = "newton_euler"
)" << solver;
    outcome =
        test::run_program("pent-sim " + (folder / "bar.toml").string() + " -o "
                          + (folder / "run").string() + " --json " + (folder / "all").string());
    return nlohmann::json::parse(test::text_of(folder / "all"));
}

// A run that goes on from a frame in which everything is at one point: no force is left to undo
// that.
TEST(PentSim, SaysThatElementsHaveCollapsed) {
    const pent::test::TempFolder folder;
    write_mesh(folder / "box.pent", pent::test::kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 1}));
    const auto run = [&](int frames, const char* how) {
        std::ofstream(folder / "box.toml") << "[scene]\nframes = " << frames
                                           << "\n[[body]]\nname = \"box\"\nmesh = \"box.pent\"\n";
        return test::run_program("pent-sim " + (folder / "box.toml").string() + " -o "
                                 + (folder / "run").string() + how);
    };
    ASSERT_EQ(run(1, "").exit_code, 0);
    const auto path = folder / "run/frames/box_000001.pent";
    Frame<4> frame = read_frame<4>(path);
    frame.positions.setZero();
    write_frame(path, frame);
    const Outcome outcome = run(2, " --resume");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    expect_contains(outcome.out,
                    {"24 of 24 elements have collapsed", "finished with collapsed elements"});
}

TEST(PentSim, SaysThatElementsAreInsideOut) {
    Outcome outcome;
    const nlohmann::json report = push_through(-2, "", outcome);  // the ends have changed sides
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const int inverted = report.at("inverted");
    EXPECT_GT(inverted, 0);  // the two ends alone have the signed volume of a bar inside out
    EXPECT_GT(report.at("inverted_steps"), 2);
    expect_contains(outcome.out,
                    {std::to_string(inverted) + " of 12 cells are inside out at the end",
                     "finished with inverted cells"});
}

TEST(PentSim, SaysWhyStepsWereCut) {
    Outcome outcome;
    const nlohmann::json report =
        push_through(-2, "max_iterations = 2\npreconditioner = \"block-jacobi\"\n", outcome);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const int refused = report.at("refused");
    EXPECT_GT(refused, 0);
    expect_contains(outcome.out, {std::to_string(refused) + " attempts at steps were cut in two",
                                  "because the linear solver did not reach its tolerance"});
}

TEST(PentSim, SaysNothingOfElementsThatAreNot) {
    Outcome outcome;
    const nlohmann::json report = push_through(0.1, "", outcome);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(report.at("inverted"), 0);
    EXPECT_EQ(report.at("refused"), 0);
    EXPECT_EQ(outcome.out.find("inside out"), std::string::npos);
    EXPECT_EQ(outcome.out.find("inverted"), std::string::npos);
    EXPECT_EQ(outcome.out.find("cut"), std::string::npos);
}

// A cube that falls, beside another one a meter away.
class FallingCubes : public testing::Test {
protected:
    FallingCubes() {
        write_mesh(folder_ / "cube.pent", test::kuhn_box<3>({1, 1, 1}, {0.5, 0.5, 0.5}));
        std::ofstream(folder_ / "fall.toml") << R"([scene]
dimension = 3
gravity = [0, -9.8, 0]
frames = 3

[[body]]
name = "a"
mesh = "cube.pent"

[[body]]
name = "b"
mesh = "cube.pent"
place = { translate = [1.5, 0, 0] }

[contact]
distance = 0.04
)";
    }

    [[nodiscard]] std::string path(const std::string& name) const {
        return (folder_ / name).string();
    }

    test::TempFolder folder_;
};

TEST_F(FallingCubes, NeverTouchAndPentSimSaysSo) {
    const Outcome outcome =
        test::run_program("pent-sim " + path("fall.toml") + " -o " + path("run"));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    expect_contains(outcome.out, {"contact: ", "% of the time; nothing touches at the end"});
    EXPECT_EQ(outcome.out.find("pairs"), std::string::npos) << outcome.out;
}

TEST_F(FallingCubes, AreWarnedOfADistanceOfContactNearTheLengthOfTheirEdges) {
    std::string text = test::text_of(folder_ / "fall.toml");
    text.replace(text.find("distance = 0.04"), 15, "distance = 0.4");
    std::ofstream(folder_ / "fall.toml") << text;
    const Outcome outcome =
        test::run_program("pent-sim " + path("fall.toml") + " -o " + path("run"));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    expect_contains(outcome.out, {"warning: contact distance 0.4 m", "of body 'a'", "of body 'b'"});
}

TEST_F(FallingCubes, AreExplainedWithoutBeingRun) {
    const Outcome outcome = test::run_program("pent-sim " + path("fall.toml") + " --explain --json "
                                              + path("report.json"));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const auto report = nlohmann::json::parse(test::text_of(folder_ / "report.json"));
    EXPECT_EQ(report.at("verdict"), "finished");
    double bytes = 0;
    for (const auto& term : report.at("terms")) {
        expect_contains(outcome.out, {term.at("name").get<std::string>()});
        bytes += term.at("bytes").get<double>();
    }
    EXPECT_GT(bytes, 0);
    EXPECT_FALSE(report.at("advice").empty());  // the contact has nothing to do
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 3);
}

TEST_F(FallingCubes, NeedAFolderToRunIn) {
    const Outcome outcome = test::run_program("pent-sim " + path("fall.toml"));
    EXPECT_EQ(outcome.exit_code, 2);
    test::expect_one_error_line(outcome, "pent-sim");
    expect_contains(outcome.err, {"--output"});
}

TEST_F(FallingCubes, DivergeWithAVerdictWhenNoIterationsAreAllowed) {
    std::ofstream(folder_ / "fall.toml", std::ios::app)
        << "[solver]\nmax_iterations = 1\ntolerance = 1e-12\nmax_halvings = 0\n";
    const Outcome outcome = test::run_program("pent-sim " + path("fall.toml") + " -o " + path("run")
                                              + " --json " + path("report.json"));
    EXPECT_EQ(outcome.exit_code, 3);
    test::expect_one_error_line(outcome, "pent-sim");
    const auto report = nlohmann::json::parse(test::text_of(folder_ / "report.json"));
    EXPECT_EQ(report.at("verdict"), "diverged");
    expect_contains(outcome.err, {"diverged at " + report.at("message").get<std::string>()});
}

// A project with folders named as those of a run, in which one works: nothing of it is lost.
TEST_F(FallingCubes, AreNotTouchedInAFolderOfTheirOwn) {
    std::filesystem::create_directories(folder_ / "meshes");
    std::filesystem::rename(folder_ / "cube.pent", folder_ / "meshes/cube.pent");
    std::string text = test::text_of(folder_ / "fall.toml");
    for (std::size_t at = 0; (at = text.find("\"cube.pent", at)) != std::string::npos; at += 9) {
        text.insert(at + 1, "meshes/");
    }
    std::ofstream(folder_ / "scene.toml") << text;
    const std::string mesh = test::text_of(folder_ / "meshes/cube.pent");
    for (const char* how : {"", " --force", " --resume"}) {
        const Outcome outcome = test::run_program("pent-sim scene.toml -o ." + std::string(how),
                                                  "cd " + folder_.path().string() + ";");
        EXPECT_EQ(outcome.exit_code, 1) << how;
        test::expect_one_error_line(outcome, "pent-sim");
        EXPECT_EQ(test::text_of(folder_ / "meshes/cube.pent"), mesh) << how;
        EXPECT_EQ(test::text_of(folder_ / "scene.toml"), text) << how;
    }
}

TEST_F(FallingCubes, AreNotReplacedByAReport) {
    const std::string scene = test::text_of(folder_ / "fall.toml");
    const std::string mesh = test::text_of(folder_ / "cube.pent");
    std::filesystem::create_symlink(folder_ / "fall.toml", folder_ / "link.toml");
    for (const char* json : {"fall.toml", "./fall.toml", "link.toml", "cube.pent"}) {
        const Outcome outcome = test::run_program("pent-sim " + path("fall.toml") + " -o "
                                                  + path("run") + " --json " + path(json));
        EXPECT_EQ(outcome.exit_code, 1);
        test::expect_one_error_line(outcome, "pent-sim");
        expect_contains(outcome.err, {"--json is the same file as ", "give it another name"});
        EXPECT_EQ(test::text_of(folder_ / "fall.toml"), scene);
        EXPECT_EQ(test::text_of(folder_ / "cube.pent"), mesh);
    }
    // The report of a refusal must not, either.
    std::ofstream(folder_ / "broken.toml") << "[scene\n";
    const Outcome outcome = test::run_program("pent-sim " + path("broken.toml") + " -o "
                                              + path("run") + " --json " + path("broken.toml"));
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_EQ(test::text_of(folder_ / "broken.toml"), "[scene\n");
}

// Whether the run is there, and is refused, or not yet.
TEST_F(FallingCubes, HaveNoReportInPlaceOfAPartOfTheRun) {
    const std::string command = "pent-sim " + path("fall.toml") + " -o " + path("run") + " --json ";
    const std::vector<std::string> parts = {
        "report.json",     "journal.txt", "written.txt", "scene.toml", "frames/cube_000001.pent",
        "meshes/cube.pent"};
    const auto refuse_all = [&] {
        for (const std::string& part : parts) {
            const Outcome outcome = test::run_program(command + path("run/" + part));
            EXPECT_EQ(outcome.exit_code, 1) << part;
            expect_contains(outcome.err, {"a part of the run", "give it another name"});
        }
    };
    refuse_all();
    EXPECT_FALSE(std::filesystem::exists(path("run")));
    ASSERT_EQ(test::run_program(command + path("all.json")).exit_code, 0);
    const std::string report = test::text_of(path("run/report.json"));
    refuse_all();
    EXPECT_EQ(test::text_of(path("run/report.json")), report);
}

TEST_F(FallingCubes, AreAskedForInOurWordsWhateverIsGiven) {
    const auto error = [&](const std::string& arguments) {
        const Outcome outcome = test::run_program("pent-sim " + arguments);
        EXPECT_EQ(outcome.exit_code, 1) << arguments;
        test::expect_one_error_line(outcome, "pent-sim");
        EXPECT_EQ(outcome.err.find("filesystem error"), std::string::npos) << outcome.err;
        EXPECT_EQ(outcome.err.find("basic_"), std::string::npos) << outcome.err;
        return outcome.err;
    };
    const std::string scene = path("fall.toml");
    const std::string folder = folder_.path().string();
    expect_contains(error(folder + " -o " + path("run")),
                    {folder + ": is a folder; give the scene in it: " + scene + "\n"});
    for (const char* name : {"b", "a", "g", "e", "d", "c"}) {
        std::filesystem::create_directory(path("many"));
        std::ofstream(folder_ / "many" / (std::string(name) + ".toml")) << "[scene]\n";
    }
    std::filesystem::create_directory(folder_ / "many" / "0.toml");
    std::ofstream(folder_ / "many" / "notes.txt") << "none\n";
    expect_contains(error(path("many") + " --explain"),
                    {": is a folder; give one of the scenes in it: " + path("many/a.toml") + ", ",
                     path("many/e.toml") + " and 1 more\n"});
    expect_contains(error(path("many/0.toml") + " --explain"),
                    {"0.toml: is a folder, with no scene file (.toml) in it\n"});
    expect_contains(error(path("fall.toml") + " -o " + path(std::string(300, 'n'))),
                    {"File name too long"});
    expect_contains(error(path("fall.toml") + " -o " + path("fall.toml")), {"is a file"});
    // A name of bytes that are no text is shown as numbers.
    expect_contains(error(path("$'no\\xff\\x1b[31m.toml'") + " -o " + path("run")),
                    {"no\\xff\\x1b[31m.toml"});
}

TEST_F(FallingCubes, ThatGoDeepSayWhichStiffnessWouldDo) {
    std::ofstream(folder_ / "fall.toml", std::ios::app) << R"(
[[obstacle]]
half_space = { normal = [0, 1, 0], offset = -0.01 }
stiffness = 10
)";
    std::string text = test::text_of(folder_ / "fall.toml");
    text.replace(text.find("frames = 3"), 10, "frames = 15");
    std::ofstream(folder_ / "fall.toml") << text;
    const Outcome outcome =
        test::run_program("pent-sim " + path("fall.toml") + " -o " + path("run"));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    expect_contains(outcome.out, {"penetration reached",
                                  "[[obstacle]] 1 stiffness = ", "finished with deep penetration"});
    expect_contains(test::text_of(folder_ / "run/report.json"), {"\"penetration\""});
}

TEST_F(FallingCubes, ShowTheirProgressOnOneLineOfATerminal) {
    if (std::system("command -v script >/dev/null") != 0) {  // NOLINT(cert-env33-c)
        GTEST_SKIP() << "no script to make a terminal";
    }
    const std::string line = "script -qec '" PENT_BIN "/pent-sim " + path("fall.toml") + " -o "
                             + path("run") + "' /dev/null >" + path("seen") + " </dev/null";
    ASSERT_EQ(std::system(line.c_str()), 0);  // NOLINT(cert-env33-c)
    expect_contains(test::text_of(folder_ / "seen"), {"\rframe 3 of 3", "\x1b[K\r\n"});
}

}  // namespace
}  // namespace pent
