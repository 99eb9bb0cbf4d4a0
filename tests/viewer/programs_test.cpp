#include "runs.h"

#include <pent/obstacles_file.h>
#include <pent/output_file.h>

#include <gtest/gtest.h>

#include <apps/run_program.h>
#include <map>
#include <support/temp_folder.h>

namespace pent::viewer {
namespace {

using pent::test::expect_one_error_line;
using pent::test::Outcome;
using pent::test::run_program;
using pent::test::TempFolder;

class ViewerPrograms : public testing::Test {
protected:
    ViewerPrograms() { test::write_run(folder_ / "run", "a", {0, 1, 2}); }

    [[nodiscard]] std::string at(const std::string& name) const {
        return (folder_ / name).string();
    }

    // Expects exit code 1 with one line on stderr that has `part` in it.
    void expect_refused(const std::string& program,
                        const std::string& arguments,
                        const std::string& part,
                        const std::string& before = "") const {
        const Outcome outcome = run_program(program + " " + arguments, before);
        EXPECT_EQ(outcome.exit_code, 1) << arguments;
        expect_one_error_line(outcome, program);
        EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
    }

    TempFolder folder_;
};

TEST_F(ViewerPrograms, SliceARunInTheWaysShownInTheHelp) {
    const std::string run = at("run") + " -o " + at("out");
    for (const std::string options :
         {" --w -0.1,0.2 --color strain", " --w=-0.1 --w 0.3 --frames 1:2",
          " --w -0.1:0.4:3 --format vtu", " --normal 0,1,0,1 --offset -0.1,0.5 --format obj",
          " --rotate xw:30 --rotate yz:-45 --color w",
          " --rotate yz:10 --rotate xw:0:40:3 --boundary", " --keep-degenerate --frames last"}) {
        const Outcome outcome = run_program(std::string("pent-slice ").append(run).append(options));
        EXPECT_EQ(outcome.exit_code, 0) << options << outcome.err;
        EXPECT_NE(outcome.out.find("finished: "), std::string::npos) << outcome.out;
    }
}

TEST_F(ViewerPrograms, TakeTheirInputBehindAnyOption) {
    for (const std::string options :
         {"--w 0.1", "--w 0.1 --w -0.2", "--rotate xw:30", "--normal 0,0,1,1 --offset -0.1"}) {
        std::string command = "pent-slice -o " + at("out");
        command.append(" ").append(options).append(" ").append(at("run"));
        EXPECT_EQ(run_program(command).exit_code, 0) << options;
    }
}

TEST_F(ViewerPrograms, WriteTheSameBytesForAnyNumberOfThreads) {
    const std::string rest = " --w 0.1,0.5 --color strain --project perspective -o ";
    for (const std::string threads : {"1", "3"}) {
        std::string command = "pent-slice " + at("run");
        command.append(" --threads ").append(threads).append(rest).append(at("out" + threads));
        const Outcome outcome = run_program(command);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    }
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "out1")) {
        const std::filesystem::path other = folder_ / "out3" / entry.path().filename();
        EXPECT_EQ(pent::test::text_of(entry.path()), pent::test::text_of(other)) << other;
    }
}

TEST_F(ViewerPrograms, RenderAPictureOfTheLastFrame) {
    const Outcome outcome =
        run_program("pent-render " + at("run") + " --size 64x48 -o " + at("a.png"));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_TRUE(std::filesystem::exists(folder_ / "a.png"));
}

TEST_F(ViewerPrograms, ExportForcesOfContactWithTheBoundaryWhereFramesHaveThem) {
    const std::string command =
        "pent-slice " + at("run") + " --frames 2 --boundary --format vtu -o ";
    const auto has_force = [&](const std::string& out) {
        const Outcome outcome = run_program(command + at(out));
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        return pent::test::text_of(folder_ / out / "a.boundary_000002.vtu").find("\"force\"")
               != std::string::npos;
    };
    EXPECT_FALSE(has_force("without"));
    const std::filesystem::path path = folder_ / "run/frames/a_000002.pent";
    Frame<4> frame = read_frame<4>(path);
    frame.contact_forces = frame.velocities;
    write_frame(path, frame);
    EXPECT_TRUE(has_force("with"));
}

TEST_F(ViewerPrograms, TakeTheRangeOfColorsAndThePlaceOfTheEyeAsTold) {
    const std::string color = " --size 64x48 --color speed -o ";
    ASSERT_EQ(
        run_program("pent-render " + at("run") + color + at("a.png") + " --range 0,2").exit_code,
        0);
    ASSERT_EQ(
        run_program("pent-render " + at("run") + color + at("b.png") + " --range 0,9").exit_code,
        0);
    EXPECT_NE(pent::test::text_of(folder_ / "a.png"), pent::test::text_of(folder_ / "b.png"));
    const std::string outline = "pent-slice " + at("run") + " --frames 0 --project perspective -o ";
    ASSERT_EQ(run_program(outline + at("near") + " --eye 5").exit_code, 0);
    ASSERT_EQ(run_program(outline + at("far") + " --eye 50").exit_code, 0);
    const auto outline_in = [&](const std::string& name) {
        return pent::test::text_of(folder_ / (name + "/a.outline_000000.ply"));
    };
    EXPECT_NE(outline_in("near"), "");
    EXPECT_NE(outline_in("near"), outline_in("far"));
}

TEST_F(ViewerPrograms, RenderAMovieWithFfmpeg) {
    if (std::system("command -v ffmpeg >/dev/null 2>&1") != 0) {  // NOLINT(cert-env33-c)
        GTEST_SKIP() << "no ffmpeg";
    }
    const Outcome outcome =
        run_program("pent-render " + at("run") + " --size 64x48 -o " + at("a.mp4"));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(pent::test::text_of(folder_ / "a.mp4").substr(4, 4), "ftyp");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a_pictures"));
}

TEST_F(ViewerPrograms, FallBackToPicturesWithoutFfmpeg) {
    const Outcome outcome = run_program(
        "pent-render " + at("run") + " --size 64x48 -o " + at("a.mp4"), "PATH=/nonexistent");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("no ffmpeg"), std::string::npos) << outcome.out;
    EXPECT_TRUE(std::filesystem::exists(folder_ / "a_pictures/000002.png"));
}

TEST_F(ViewerPrograms, RefuseBadInputInOneLine) {
    const std::string out = " -o " + at("out");
    expect_refused("pent-slice", at("none") + out, "no such file");
    expect_refused("pent-slice", at("run") + out + " --frames 9", "no frame 9");
    expect_refused("pent-slice", at("run") + out + " --w 1,x", "expected a number");
    expect_refused("pent-slice", at("run") + out + " --color force",
                   "vertex = [\"contact_force\"]");
    expect_refused("pent-slice", at("run") + out + " --w 0:1:1", "N at least 2");
    expect_refused("pent-slice", at("run") + out + " --rotate xx:3", "--rotate");
    expect_refused("pent-slice", at("run") + out + " --rotate xw:0:9:3,xy:1", "only the last");
    expect_refused("pent-slice", at("run") + out + " --normal 0,0,0,0", "normal");
    expect_refused("pent-slice", at("run") + out + " --normal 1,2", "expected four");
    expect_refused("pent-slice", at("run") + out + " --offset 1", "--normal");
    expect_refused("pent-slice", at("run") + out + " --eye 3", "--project perspective");
    expect_refused("pent-render", at("run"), "nothing to make");
    expect_refused("pent-render", at("run") + " -o " + at("a.avi"), ".mp4 or .png");
    expect_refused("pent-render", at("run") + " -o " + at("a.png") + " --size 3", "--size");
    expect_refused("pent-render", at("run") + " -o " + at("a.png") + " --size 64xq", "--size");
    expect_refused("pent-render", at("run") + " --sheet " + at("a.jpg"), ".png");
    expect_refused("pent-render", at("run") + " -o " + at("a.png") + " --range 2,1", "--range");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(ViewerPrograms, NeverWriteOverWhatTheyLookAt) {
    const std::string run = at("run");
    const auto content = [&] {
        std::map<std::filesystem::path, std::string> files;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_ / "run")) {
            if (entry.is_regular_file()) {
                files[entry.path()] = pent::test::text_of(entry.path());
            }
        }
        return files;
    };
    write_text(folder_ / "run/scene.toml", "[scene]\n");
    write_text(folder_ / "run/report.json", "{}\n");
    std::filesystem::create_symlink("run/frames/a_000002.pent", folder_ / "link.json");
    const auto before = content();
    for (const std::string out : {"run", "run/", "run/meshes", "run/frames/new", "x/../run"}) {
        expect_refused("pent-slice", run + " -o " + at(out), "what is looked at");
        expect_refused("pent-render", run + " -o " + at(out) + "/", "what is looked at");
        expect_refused("pent-view", run + " --export " + at(out), "what is looked at");
    }
    for (const std::string json :
         {"run/scene.toml", "run/report.json", "run/obstacles.json", "run/journal.txt",
          "run/meshes/a.pent", "run/frames/a_000001.pent", "run/obstacles/000001.json",
          "run/balance.csv", "link.json"}) {
        const std::string rest = " --json " + at(json);
        expect_refused("pent-slice", run + " -o " + at("out") + rest, "--json");
        expect_refused("pent-render", run + " -o " + at("a.png") + rest, "--json");
        expect_refused("pent-view", run + " --export " + at("a.html") + rest, "--json");
        expect_refused("pent-slice", run + " -o " + at(json) + rest, "--json");
    }
    const std::string mesh = at("run/meshes/a.pent");
    expect_refused("pent-render", mesh + " -o " + at("a.png") + " --json " + mesh, "--json");
    EXPECT_EQ(content(), before);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
    expect_refused("pent-render", run + " -o " + at("a.png") + " --frames 1 --sheet " + at("a.png"),
                   "--sheet is the same file");
    // What they write themselves is looked at next.
    for (const std::string name : {"slices.csv", "a_000001.ply", "a.pvd"}) {
        expect_refused("pent-slice", run + " -o " + at("out") + " --json " + at("out/" + name),
                       "--json is the same file as a file of --output");
    }
    for (const std::string option : {"--json ", "--sheet "}) {
        expect_refused("pent-render",
                       run + " -o " + at("pictures/") + " " + option + at("pictures/000001.png"),
                       option + "is the same file as a file of --output");
    }
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "pictures"));
    EXPECT_EQ(run_program("pent-render " + run + " --size 64x48 --frames 1 -o " + at("pictures/")
                          + " --sheet " + at("pictures/sheet.png") + " --json "
                          + at("pictures/report.json"))
                  .exit_code,
              0);
    // Beside what the run is made of there is room.
    EXPECT_EQ(run_program("pent-slice " + run + " -o " + at("run/slices")).exit_code, 0);
}

TEST_F(ViewerPrograms, MakeTheFoldersOfTheirFiles) {
    const std::string small = " --size 64x48 --frames 1";
    ASSERT_EQ(run_program("pent-render " + at("run") + small + " -o " + at("new/b/a.png")
                          + " --sheet " + at("other/sheet.png"))
                  .exit_code,
              0);
    EXPECT_TRUE(std::filesystem::exists(folder_ / "new/b/a.png"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "other/sheet.png"));
    // A movie, or the pictures in its place where there is no ffmpeg.
    ASSERT_EQ(
        run_program("pent-render " + at("run") + " --size 64x48 -o " + at("films/a.mp4")).exit_code,
        0);
    EXPECT_FALSE(std::filesystem::is_empty(folder_ / "films"));
    expect_refused("pent-render", at("run") + small + " -o " + at("new/b/a.png/c.png"),
                   "cannot be made");
}

TEST_F(ViewerPrograms, SayInOneLineWhatNamesAreTooLong) {
    const std::string name(300, 'n');
    expect_refused("pent-slice", at(name) + " -o " + at("out"), "no such file");
    expect_refused("pent-slice", at("run") + " -o " + at(name), "File name too long");
    for (const std::string end : {".png", "/", ".mp4"}) {
        expect_refused("pent-render", at("run") + " --frames 1 -o " + at(name + end),
                       "File name too long");
    }
}

TEST_F(ViewerPrograms, SayWhichFolderCannotBeRead) {
    const std::string other = "setpriv --reuid=65534 --clear-groups ";
    // NOLINTNEXTLINE(cert-env33-c)
    if (std::system((other + "test -x " PENT_BIN "/pent-slice 2>/dev/null").c_str()) != 0) {
        GTEST_SKIP() << "only root may become somebody else, who must get to the programs";
    }
    namespace fs = std::filesystem;
    fs::permissions(folder_.path(), fs::perms::all);
    for (const std::string part : {"run/meshes", "run/frames", "run"}) {
        fs::permissions(folder_ / part, fs::perms::owner_all);
        expect_refused("pent-slice", at("run") + " -o " + at("out"), "Permission denied", other);
        fs::permissions(folder_ / part, fs::perms::all);
    }
}

TEST_F(ViewerPrograms, SayWhereObstaclesAre) {
    const std::string slice = "pent-slice " + at("run") + " --frames 1 -o ";
    EXPECT_EQ(run_program(slice + at("a")).out.find("obstacle"), std::string::npos);
    write_obstacles<4>(folder_ / "run/obstacles.json",
                       {HalfSpace<4>{Eigen::Vector4d::UnitY(), -0.1}});
    EXPECT_NE(run_program(slice + at("b")).out.find("1 obstacle left out (see --obstacles)"),
              std::string::npos);
    EXPECT_NE(run_program(slice + at("c") + " --obstacles").out.find("1 obstacle in files of"),
              std::string::npos);
    EXPECT_TRUE(std::filesystem::exists(folder_ / "c/obstacle.1_000001.ply"));
    const std::string render = "pent-render " + at("run") + " --size 64x48 -o ";
    ASSERT_EQ(run_program(render + at("with.png")).exit_code, 0);
    ASSERT_EQ(run_program(render + at("without.png") + " --no-obstacles").exit_code, 0);
    EXPECT_NE(pent::test::text_of(folder_ / "with.png"),
              pent::test::text_of(folder_ / "without.png"));
}

TEST_F(ViewerPrograms, RefuseUnknownFormatsAsWrongUsage) {
    EXPECT_EQ(run_program("pent-slice " + at("run") + " -o x --format stl").exit_code, 2);
    EXPECT_EQ(run_program("pent-slice " + at("run")).exit_code, 2);
}

TEST_F(ViewerPrograms, TakeWordsInAnyLetters) {
    const auto written = [&](const std::string& out, const std::string& words) {
        const Outcome outcome =
            run_program("pent-slice " + at("run") + " --frames 2 -o " + at(out) + words);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        return pent::test::text_of(folder_ / out / "a_000002.obj")
               + pent::test::text_of(folder_ / out / "a.outline_000002.obj");
    };
    EXPECT_EQ(written("large", " --format OBJ --project Perspective --eye 3"),
              written("small", " --format obj --project perspective --eye 3"));
}

// Only what is looked at tells which quantities there are.
TEST_F(ViewerPrograms, RefuseColorsOfNothingWithWhatThereIs) {
    for (const char* program : {"pent-slice", "pent-render"}) {
        const std::string out = program == std::string("pent-slice") ? "out" : "out.png";
        expect_refused(program, at("run") + " -o " + at(out) + " --color sped",
                       "did you mean \"speed\"? There are body, w, speed");
        EXPECT_FALSE(std::filesystem::exists(folder_ / "out.png"));
    }
}

TEST_F(ViewerPrograms, LeaveNothingBehindOnAFullDisk) {
    const std::string full = pent::test::full_disk(1024);
    expect_refused("pent-slice", at("run") + " -o " + at("out"), "cannot be written", full);
    expect_refused("pent-render", at("run") + " -o " + at("b.png"), "cannot be written", full);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "b.png"));
    EXPECT_TRUE(std::filesystem::is_empty(folder_ / "out"));
}

TEST_F(ViewerPrograms, LeaveNoMovieOnAFullDisk) {
    if (std::system("command -v ffmpeg >/dev/null 2>&1") != 0) {  // NOLINT(cert-env33-c)
        GTEST_SKIP() << "no ffmpeg";
    }
    const Outcome outcome =
        run_program("pent-render " + at("run") + " -o " + at("a.mp4"), pent::test::full_disk(4096));
    EXPECT_EQ(outcome.exit_code, 1);
    expect_one_error_line(outcome, "pent-render");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.mp4"));
}

}  // namespace
}  // namespace pent::viewer
