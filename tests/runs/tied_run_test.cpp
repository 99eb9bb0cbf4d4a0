#include "simulator/contact_scenes.h"
#include "support/temp_folder.h"

#include <pent/pent_file.h>
#include <pent/runs/explain.h>
#include <pent/runs/run.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

// Runs of scenes in which bodies are tied, held for a while, and let go.

namespace pent::runs {
namespace {

using namespace simulator;
namespace fs = std::filesystem;
using pent::test::TempFolder;
using simulator::test::cube;
using simulator::test::still;

constexpr int kFrames = 12;

// b hangs on a by springs of which some break; a is held, let go and caught again; b is grabbed
// for a while by a point that moves. Both fall onto a floor.
template <int Dim>
Scene tied_scene(Integrator integrator, const TempFolder& folder) {
    write_mesh(folder / "cube.pent", cube<Dim>(1));
    Scene scene = simulator::test::two_cubes<Dim>(0.1);
    scene.bodies[1].place.translate[1] = -0.27;
    for (Body& body : scene.bodies) {
        body.mesh = (folder / "cube.pent").string();
    }
    scene.gravity[1] = -9.8;
    scene.frames = kFrames;
    scene.solver.integrator = integrator;
    scene.obstacles = {
        {.shape = HalfSpaceObstacle{.normal = Eigen::VectorXd::Unit(Dim, 1), .offset = -0.3}}};
    scene.sleep = Sleep{.speed = 1e-3, .time = 0.02};
    Constraint hold{.body = "a", .select = {EverythingSelection{}}, .motion = {}};
    hold.to = 0.03;
    Constraint grab = hold;
    grab.from = 0.06;
    grab.to = 0.09;
    grab.motion = {still(Dim)};
    grab.motion[0].translate[0] = 1;
    scene.constraints = {hold, grab};
    Attachment tie;
    tie.body = "b";
    tie.target = "a";
    tie.select = {HalfSpaceSelection{.normal = -Eigen::VectorXd::Unit(Dim, 1), .offset = 0.1}};
    tie.max_distance = 0.1;
    tie.stiffness = 1e4;
    tie.damping = 10;
    tie.break_force = 2;
    Attachment drag;
    drag.body = "b";
    drag.select = {EverythingSelection{}};
    drag.point = Eigen::VectorXd::Zero(Dim);
    drag.motion = {still(Dim)};
    drag.motion[0].translate[0] = -1;
    drag.from = 0.02;
    drag.to = 0.08;
    scene.attachments = {tie, drag};
    return scene;
}

std::string bytes_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

template <int Dim>
void expect_to_go_on(Integrator integrator) {
    const TempFolder folder;
    const Scene scene = tied_scene<Dim>(integrator, folder);
    const RunReport whole = run(scene, {.folder = folder / "whole", .threads = 2});
    ASSERT_EQ(whole.verdict, RunVerdict::Finished) << whole.message;
    const std::int64_t broken = whole.steps.back().attachments.at(0).broken;
    EXPECT_GT(broken, 0);
    for (int stop = 1; stop < kFrames; ++stop) {
        const fs::path cut = folder / ("cut" + std::to_string(stop));
        int steps = stop;
        static_cast<void>(run(scene, {.folder = cut},
                              {.should_stop = [&] { return steps-- == 0; }, .on_frame = {}}));
        const RunReport resumed = run(scene, {.folder = cut, .resume = true});
        for (const char* name : {"a_000012.pent", "b_000012.pent"}) {
            EXPECT_EQ(bytes_of(folder / "whole/frames" / name), bytes_of(cut / "frames" / name))
                << stop;
        }
        ASSERT_EQ(resumed.steps.size(), whole.steps.size());
        for (std::size_t i = 0; i < whole.steps.size(); ++i) {
            EXPECT_EQ(resumed.steps[i].unknowns, whole.steps[i].unknowns);
            EXPECT_EQ(resumed.steps[i].attachments.at(0).broken,
                      whole.steps[i].attachments.at(0).broken);
            EXPECT_EQ(resumed.steps[i].attachments.at(1).force,
                      whole.steps[i].attachments.at(1).force);
        }
    }
}

TEST(RunOfTiedBodies, ResumesToTheSameBytesIn3D) {
    for (const Integrator integrator :
         {Integrator::LinearEuler, Integrator::NewtonEuler, Integrator::Bdf2}) {
        expect_to_go_on<3>(integrator);
    }
}

TEST(RunOfTiedBodies, ResumesToTheSameBytesIn4D) {
    expect_to_go_on<4>(Integrator::Bdf2);
}

TEST(Explain, ListsEveryAttachment) {
    const TempFolder folder;
    Scene scene = tied_scene<3>(Integrator::NewtonEuler, folder);
    const std::string text = explanation_text(explain(scene, 1));
    EXPECT_NE(text.find("attachment of b"), std::string::npos);
    EXPECT_NE(text.find("4 vertices to a, 1e+04 N/m, all together 4e+04 N/m, breaks at 2 N"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("8 vertices to points that move, 1000 N/m, all together 8000 N/m, from"),
              std::string::npos)
        << text;
    scene.attachments.clear();
    EXPECT_NE(explanation_text(explain(scene, 1)).find("no [[attachment]]"), std::string::npos);
}

}  // namespace
}  // namespace pent::runs
