#include "simulator/barrier_scenes.h"
#include "support/cut_in_two.h"
#include "support/temp_folder.h"

#include <pent/pent_file.h>
#include <pent/read_text.h>
#include <pent/runs/run.h>
#include <pent/runs/scene_file.h>

#include <gtest/gtest.h>

#include <algorithm>

// Runs of quadratic elements in four dimensions, with all that comes and goes on the way: the table
// of resumed runs has them in three alone, for time.

namespace pent::runs {
namespace {

namespace fs = std::filesystem;
using pent::test::TempFolder;
using namespace simulator;

// One end of a is led through keyframes and let go of while a muscle works in it; b comes down upon
// it, sliding, tied to it by springs that break and pulled by a point that moves, under a load that
// grows. The ground rises. Eight steps of 10 ms.
constexpr std::string_view kScene = R"([scene]
frames = 8
frames_per_second = 100

[[body]]
name = "a"
mesh = "a.pent"

[[body]]
name = "b"
mesh = "b.pent"
place = { translate = [0.05, 0.23, 0.01, 0.02] }
velocity = [0.5, -1, 0, 0]

[[constraint]]
body = "a"
select = { half_space = { normal = [1, 0, 0, 0], offset = -0.09 } }
to = 0.05
motion = { keyframes = [
  { time = 0.05, translate = [0, 0.01, 0, 0.01], rotate = [{ plane = "zw", degrees = 4 }] }] }

[[attachment]]
body = "b"
select = { half_space = { normal = [0, 1, 0, 0], offset = 0.14 } }
target = "a"
max_distance = 0.1
stiffness = 100
from = 0.02
break_force = 1.5

[[attachment]]
body = "b"
select = { half_space = { normal = [0, -1, 0, 0], offset = -0.32 } }
stiffness = 20
to = 0.06
motion = { keyframes = [{ time = 0.05, translate = [0.05, 0, 0.02, 0] }] }

[[activation]]
body = "a"
select = "everything"
stretch = 0.9
fibers = "constant"
direction = [0, 0, 0, 1]
signal = "pulses"
frequency = 20

[[load]]
body = "b"
select = { half_space = { normal = [0, -1, 0, 0], offset = -0.32 } }
force = [0, -40, 0, 5]
keyframes = [{ time = 0.02, factor = 0 }, { time = 0.06, factor = 1 }]

[[obstacle]]
half_space = { normal = [0, 1, 0, 0], offset = -0.13 }
motion = { keyframes = [{ time = 0.06, translate = [0, 0.01, 0, 0] }] }
friction = 0.3

[contact]
model = "barrier"
distance = 0.02
stiffness = 20
friction = 0.4

[solver]
integrator = "bdf2"
elements = "quadratic"

[output]
balance = true
)";

// Whether everything that the scene is there for came, and went.
void expect_busy(const RunReport& report) {
    ASSERT_EQ(report.verdict, RunVerdict::Finished) << report.message;
    ASSERT_EQ(report.steps.size(), 8U);
    const auto springs = [&](std::size_t step, std::size_t tie) {
        return report.steps[step].attachments[tie].springs;
    };
    EXPECT_EQ(springs(0, 0), 0);
    EXPECT_GT(springs(3, 0), 0);
    EXPECT_GT(report.steps[7].attachments[0].broken, 0);
    EXPECT_GT(springs(3, 1), 0);
    EXPECT_EQ(springs(7, 1), 0);
    EXPECT_GT(report.steps[7].contact.point_facet + report.steps[7].contact.mixed, 0);
}

TEST(RunOfQuadraticElements, ThatAreDrivenIn4DResumesToTheSameBytes) {
    const TempFolder folder;
    const Eigen::VectorXd size = Eigen::VectorXd::Constant(4, 0.2);
    for (const char* name : {"a.pent", "b.pent"}) {
        write_mesh(folder / name,
                   pent::test::cut_in_two<4>(simulator::test::box<4>(1, 1, 1, size)));
    }
    const Scene scene = parse_scene(kScene, "s.toml", folder.path());
    expect_busy(run(scene, {.folder = folder / "whole"}));
    for (const int stop : {1, 4, 7}) {
        const fs::path cut = folder / ("cut" + std::to_string(stop));
        int steps = stop;
        static_cast<void>(run(scene, {.folder = cut},
                              {.should_stop = [&] { return steps-- == 0; }, .on_frame = {}}));
        EXPECT_EQ(run(scene, {.folder = cut, .resume = true, .threads = 2}).verdict,
                  RunVerdict::Finished);
        for (const char* file : {"balance.csv", "frames/a_000004.pent", "frames/a_000008.pent",
                                 "frames/b_000004.pent", "frames/b_000008.pent"}) {
            EXPECT_EQ(read_text(cut / file, "a file"), read_text(folder / "whole" / file, "a file"))
                << file << ", stopped at " << stop;
        }
    }
}

}  // namespace
}  // namespace pent::runs
