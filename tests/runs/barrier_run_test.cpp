#include "simulator/barrier_scenes.h"
#include "support/temp_folder.h"

#include <pent/pent_file.h>
#include <pent/runs/run.h>

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

// What a run with a barrier carries from step to step.

namespace pent::runs {
namespace {

using namespace simulator;
namespace fs = std::filesystem;
using pent::test::TempFolder;
using simulator::test::BarrierScene;
using simulator::test::box;
using simulator::test::vector;

BarrierScene<4> collision(Integrator integrator) {
    BarrierScene<4> scene;
    scene.scene.solver.integrator = integrator;
    const Eigen::VectorXd unit = Eigen::VectorXd::Constant(4, 0.2);
    scene.add(box<4>(1, 1, 1, unit), vector<4>(0, 0)).velocity = vector<4>(1, 0);
    scene.add(box<4>(1, 1, 1, unit), vector<4>(0.24, 0.01, 0.02)).velocity = vector<4>(-2, 0);
    return scene;
}

std::string read_text(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

Scene written(BarrierScene<4> scene, const TempFolder& folder, int frames) {
    for (std::size_t body = 0; body < scene.meshes.size(); ++body) {
        const fs::path path = folder / scene.scene.bodies[body].mesh;
        write_mesh(path, scene.meshes[body]);
        scene.scene.bodies[body].mesh = path.string();
    }
    scene.scene.frames = frames;
    return scene.scene;
}

TEST(RunWithBarrier, ResumesToTheSameBytes) {
    for (const Integrator integrator : {Integrator::NewtonEuler, Integrator::Bdf2}) {
        const TempFolder folder;
        BarrierScene<4> apart = collision(integrator);
        apart.scene.contact->friction = 0.3;
        const Scene scene = written(apart, folder, 6);
        const RunReport whole = run(scene, {.folder = folder / "whole"});
        ASSERT_EQ(whole.verdict, RunVerdict::Finished);
        EXPECT_GT(whole.steps.back().contact.point_facet + whole.steps.back().contact.mixed, 0);
        int asked = 0;
        static_cast<void>(run(scene, {.folder = folder / "cut"},
                              {.should_stop = [&] { return ++asked > 4; }, .on_frame = nullptr}));
        const RunReport resumed =
            run(scene, {.folder = folder / "cut", .resume = true, .threads = 2});
        EXPECT_EQ(resumed.verdict, RunVerdict::Finished);
        for (const char* file : {"frames/a_000006.pent", "frames/b_000006.pent"}) {
            EXPECT_EQ(read_text(folder / "whole" / file), read_text(folder / "cut" / file)) << file;
        }
    }
}

}  // namespace
}  // namespace pent::runs
