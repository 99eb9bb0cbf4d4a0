#include "simulator/contact_scenes.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/pent_file.h>
#include <pent/read_text.h>
#include <pent/runs/run.h>
#include <pent/runs/scene_file.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

// Runs of bodies and obstacles that go through keyframes, with the table of energies and momenta.

namespace pent::runs {
namespace {

namespace fs = std::filesystem;
using pent::test::error_of;
using pent::test::expect_contains;
using pent::test::TempFolder;
using namespace simulator;

constexpr std::string_view kScene = R"([scene]
gravity = [0, -9.8, 0, 0]
frames = 6
frames_per_second = 60
steps_per_frame = 2

[[body]]
name = "a"
mesh = "a.pent"

[[constraint]]
body = "a"
select = { half_space = { normal = [1, 0, 0, 0], offset = 1e-6 } }
to = 0.08
motion = { keyframes = [
  { time = 0.04, translate = [0, 0, 0, 0.02], rotate = [{ plane = "yz", degrees = 5 }] },
  { time = 0.08, translate = [0, 0.01, 0, 0], velocity = [0, 0.5, 0, 0.5], spin = [
    { plane = "yz", degrees_per_s = 90 }] }] }

[[obstacle]]
half_space = { normal = [0, 1, 0, 0], offset = -0.01 }
motion = { from = 0.01, keyframes = [{ time = 0.1, translate = [0.03, 0.01, 0, 0] }] }
friction = 0.2

[contact]
friction = 0.6

[solver]
integrator = "bdf2"

[output]
balance = true
)";

TEST(SceneFile, HasMotionsThroughKeyframes) {
    const Scene scene = parse_scene(kScene, "s.toml", "");
    const Motion& motion = scene.constraints[0].motion.at(0);
    ASSERT_EQ(motion.keyframes.size(), 2);
    EXPECT_EQ(motion.keyframes[0].translate, 0.02 * Eigen::Vector4d::Unit(3));
    EXPECT_EQ(motion.keyframes[0].rotate.at(0).degrees, 5);
    EXPECT_FALSE(motion.keyframes[0].velocity);
    EXPECT_EQ((*motion.keyframes[1].velocity)[1], 0.5);
    EXPECT_EQ(motion.keyframes[1].spin.at(0).degrees_per_s, 90);
    EXPECT_EQ(scene.obstacles[0].motion.at(0).keyframes.size(), 1);
    EXPECT_EQ(scene.obstacles[0].friction, 0.2);
    const std::string text = scene_text(scene);
    EXPECT_EQ(scene_text(parse_scene(text, "t.toml", "")), text);
}

TEST(SceneFile, SaysWhatDoesNotGoWithKeyframes) {
    const auto error = [](const std::string& what, const std::string& with) {
        std::string text(kScene);
        text.replace(text.find(what), what.size(), with);
        return error_of([&] { static_cast<void>(parse_scene(text, "s.toml", "")); });
    };
    expect_contains(error("motion = { from", "motion = { translate = [1, 0, 0, 0], from"),
                    {"s.toml:22:", "\"translate\" does not go together with \"keyframes\""});
    expect_contains(error("motion = { from", "motion = { to = 3, from"),
                    {"s.toml:22:", "\"to\" does not go together with \"keyframes\""});
    expect_contains(error("from = 0.01", "from = 0.1"),
                    {"s.toml:22:", "is at 0.1 s; expected it behind the start of the motion"});
    expect_contains(error("to = 0.08", "from = 0.05\nto = 0.08"),
                    {"s.toml:16:1", "is at 0.04 s, when nothing is held yet"});
    expect_contains(error("{ time = 0.04", "{ time = 0.09"), {"s.toml:15:", "must increase"});
    expect_contains(error("translate = [0, 0.01, 0, 0], velocity", "velocity = [0, 1], speed"),
                    {"s.toml:17:", "\"velocity\""});
}

// The numbers of a line, and that of the columns is that of the header.
std::vector<double> numbers_of(const std::string& line) {
    std::vector<double> numbers;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) {
        numbers.push_back(std::stod(cell));
    }
    return numbers;
}

TEST(DrivenRun, ResumesToTheSameBytesWithTheTableOfAllSteps) {
    const TempFolder folder;
    write_mesh(folder / "a.pent", simulator::test::cube<4>(1));
    const Scene scene = parse_scene(kScene, "s.toml", folder.path());
    const RunReport whole = run(scene, {.folder = folder / "whole", .threads = 2});
    ASSERT_EQ(whole.verdict, RunVerdict::Finished) << whole.message;
    const std::string table = read_text(folder / "whole" / "balance.csv", "a table");
    for (const int stop : {1, 5, 6, 11}) {
        const fs::path cut = folder / ("cut" + std::to_string(stop));
        int steps = stop;
        static_cast<void>(run(scene, {.folder = cut},
                              {.should_stop = [&] { return steps-- == 0; }, .on_frame = {}}));
        const RunReport resumed = run(scene, {.folder = cut, .resume = true});
        EXPECT_EQ(resumed.verdict, RunVerdict::Finished) << resumed.message;
        EXPECT_EQ(read_text(cut / "balance.csv", "a table"), table) << stop;
        for (const char* frame : {"frames/a_000003.pent", "frames/a_000006.pent"}) {
            EXPECT_EQ(read_text(cut / frame, "a frame"),
                      read_text(folder / "whole" / frame, "a frame"));
        }
    }
    std::istringstream lines(table);
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line,
              "step,time,kinetic,gravity,elastic,obstacle,energy,px,py,pz,pw,"
              "Lxy,Lxz,Lxw,Lyz,Lyw,Lzw");
    for (const StepReport& step : whole.steps) {
        ASSERT_TRUE(std::getline(lines, line));
        const std::vector<double> numbers = numbers_of(line);
        ASSERT_EQ(numbers.size(), 17);
        EXPECT_EQ(numbers[0], static_cast<double>(step.step));
        EXPECT_EQ(numbers[1], step.time);
        EXPECT_EQ(numbers[2], step.energies.kinetic);
        EXPECT_EQ(numbers[6], step.energies.total());
        EXPECT_EQ(std::vector<double>(numbers.begin() + 7, numbers.begin() + 11), step.momentum);
        EXPECT_EQ(std::vector<double>(numbers.begin() + 11, numbers.end()), step.angular_momentum);
    }
    EXPECT_FALSE(std::getline(lines, line));
}

TEST(DrivenRun, HasNoTableUnlessTheSceneAsks) {
    const TempFolder folder;
    write_mesh(folder / "a.pent", simulator::test::cube<4>(1));
    Scene scene = parse_scene(kScene, "s.toml", folder.path());
    scene.output.balance = false;
    scene.frames = 1;
    const RunReport report = run(scene, {.folder = folder / "run"});
    EXPECT_FALSE(fs::exists(folder / "run" / "balance.csv"));
    EXPECT_TRUE(report.steps.at(0).momentum.empty());
}

}  // namespace
}  // namespace pent::runs
