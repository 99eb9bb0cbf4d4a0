#include "simulator/contact_scenes.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/pent_file.h>
#include <pent/runs/run.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

// Runs of scenes in which bodies sleep.

namespace pent::runs {
namespace {

using namespace simulator;
namespace fs = std::filesystem;
using pent::test::TempFolder;
using simulator::test::cube;
using simulator::test::two_cubes;

// A cube that rests on a floor, pressed into it a little.
Scene cube_on_floor() {
    Scene scene = simulator::test::box_scene<3>();
    scene.gravity[1] = -9.8;
    scene.obstacles = {{.shape = HalfSpaceObstacle{.normal = Eigen::VectorXd::Unit(3, 1)},
                        .distance = 0.02,
                        .stiffness = 2e4}};
    scene.sleep = Sleep{.speed = 1e-3, .time = 0.2};
    return scene;
}

std::string read_text(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// a falls asleep; b comes down on it: stopped and resumed before, while and after a sleeps.
TEST(RunWithSleep, ResumesToTheSameBytes) {
    for (const Integrator integrator : {Integrator::LinearEuler, Integrator::Bdf2}) {
        const TempFolder folder;
        write_mesh(folder / "cube.pent", cube<3>(1));
        Scene scene = two_cubes<3>(0.1);
        scene.solver.integrator = integrator;
        for (Body& body : scene.bodies) {
            body.mesh = (folder / "cube.pent").string();
        }
        scene.bodies[1].velocity = Eigen::Vector3d(0, -1, 0);
        scene.frames = 15;
        scene.sleep = Sleep{.speed = 1e-3, .time = 0.03};
        const RunReport whole = run(scene, {.folder = folder / "whole"});
        EXPECT_TRUE(std::any_of(whole.steps.begin(), whole.steps.end(),
                                [](const auto& s) { return s.asleep == 1; }));
        for (const int stop : {2, 4, 12}) {
            int asked = 0;
            const fs::path cut = folder / ("cut" + std::to_string(stop));
            static_cast<void>(
                run(scene, {.folder = cut},
                    {.should_stop = [&] { return ++asked > stop; }, .on_frame = nullptr}));
            const RunReport resumed = run(scene, {.folder = cut, .resume = true});
            for (const char* name : {"a_000015.pent", "b_000015.pent"}) {
                EXPECT_EQ(read_text(folder / "whole/frames" / name),
                          read_text(cut / "frames" / name));
            }
            ASSERT_EQ(resumed.steps.size(), whole.steps.size());
            for (std::size_t i = 0; i < whole.steps.size(); ++i) {
                EXPECT_EQ(resumed.steps[i].unknowns, whole.steps[i].unknowns) << i;
            }
        }
    }
}

TEST(RunWithSleep, NamesTheFileThatIsMissingToResume) {
    const TempFolder folder;
    write_mesh(folder / "cube.pent", cube<3>(1));
    Scene scene = cube_on_floor();
    scene.bodies[0].mesh = (folder / "cube.pent").string();
    scene.frames = 2;
    scene.sleep->speed = 1e3;  // as good as at rest, and that is counted
    static_cast<void>(run(scene, {.folder = folder / "run"}));
    ASSERT_TRUE(fs::remove(folder / "run/checkpoint/000002.state"));
    pent::test::expect_contains(
        pent::test::error_of(
            [&] { static_cast<void>(run(scene, {.folder = folder / "run", .resume = true})); }),
        {"000002.state", "--force"});
}

}  // namespace
}  // namespace pent::runs
