#include "simulator/contact_scenes.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/pent_file.h>
#include <pent/read_text.h>
#include <pent/runs/explain.h>
#include <pent/runs/run.h>
#include <pent/runs/scene_file.h>

#include <gtest/gtest.h>

// Runs of bodies with regions and activations, and their scene files.

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

[[body]]
name = "a"
mesh = "a.pent"

[[body.region]]
name = "bone"
select = { half_space = { normal = [1, 0, 0, 0], offset = 0.25 } }
material = { model = "arap", young = 3e5, density = 2000 }

[[body.region]]
name = "skin"
select = [{ layers = { first = 0 } }, { region = 3 }]
material = { young = 2e4 }

[[activation]]
body = "a"
select = "everything"
stretch = 0.75
fibers = "constant"
direction = [0, 0, 2, 0]
preserves_volume = true
signal = "pulses"
frequency = 3
phase = 0.25
duty = 0.3
wave = [0, 0, 0, 1]

[[activation]]
body = "a"
select = { ball = { center = [0, 0, 0, 0], radius = 3 } }
stretch = 1.2
fibers = "distance"
away_from = { half_space = { normal = [1, 0, 0, 0], offset = 0 } }
signal = "sine"
distance_wave = 0.5

[[activation]]
body = "a"
select = "everything"
stretch = 1.1
keyframes = [{ time = 0, factor = 0 }, { time = 0.1, factor = 1 }]

[[obstacle]]
half_space = { normal = [0, 1, 0, 0], offset = -0.1 }

[solver]
integrator = "bdf2"
)";

TEST(SceneFile, HasRegionsAndActivations) {
    const Scene scene = parse_scene(kScene, "s.toml", "");
    const std::vector<Region>& regions = scene.bodies[0].regions;
    ASSERT_EQ(regions.size(), 2);
    EXPECT_EQ(regions[0].name, "bone");
    EXPECT_EQ(regions[0].material.model, Model::Arap);
    EXPECT_EQ(regions[0].material.density, 2000);
    EXPECT_EQ(regions[0].source, "s.toml:11:10");
    EXPECT_EQ(regions[1].select.size(), 2);
    ASSERT_EQ(scene.activations.size(), 3);
    const Activation& pulses = scene.activations[0];
    EXPECT_EQ(pulses.stretch, 0.75);
    EXPECT_EQ(pulses.direction, Eigen::Vector4d::Unit(2));
    EXPECT_TRUE(pulses.preserves_volume);
    EXPECT_EQ(pulses.signal, Signal::Pulses);
    EXPECT_EQ(pulses.duty, 0.3);
    EXPECT_EQ(pulses.wave, Eigen::Vector4d::Unit(3));
    EXPECT_EQ(scene.activations[1].away_from.size(), 1);
    EXPECT_EQ(scene.activations[1].distance_wave, 0.5);
    EXPECT_EQ(scene.activations[2].keyframes.size(), 2);
    EXPECT_EQ(scene.activations[2].fibers, Fibers::None);
    // Written out and read again it is the same.
    const std::string text = scene_text(scene);
    EXPECT_EQ(scene_text(parse_scene(text, "t.toml", "")), text);
}

TEST(SceneFile, SaysWhereAnActivationOrARegionIsWrong) {
    const auto error = [](const std::string& what, const std::string& with) {
        std::string text(kScene);
        text.replace(text.find(what), what.size(), with);
        return error_of([&] { static_cast<void>(parse_scene(text, "s.toml", "")); });
    };
    expect_contains(error("stretch = 0.75", "stretch = 0"), {"s.toml:22:11", "stretch"});
    expect_contains(error("direction = [0, 0, 2, 0]\n", ""), {"s.toml:19:1", "direction"});
    expect_contains(error("fibers = \"distance\"\n", ""),
                    {"s.toml:36:13", "\"away_from\" goes with fibers = \"distance\" alone"});
    expect_contains(
        error("away_from = { half_space = { normal = [1, 0, 0, 0], offset = 0 } }\n", ""),
        {"s.toml:36:10", "go with \"away_from\""});
    expect_contains(error("factor = 1 }]", "factor = -11 }]"), {"s.toml:45:13", "inside out"});
    expect_contains(error("duty = 0.3", "duty = 1"), {"s.toml:29:8", "duty"});
    expect_contains(error("name = \"skin\"", "name = \"bone\""),
                    {"s.toml", "two regions have the name \"bone\""});
    expect_contains(error("body = \"a\"\nselect = { ball", "body = \"b\"\nselect = { ball"),
                    {"no body is called \"b\""});
    expect_contains(error("[solver]\n", "[solver]\nelements = \"smoothed\"\n"),
                    {"activation: smoothed elements know none"});
}

// A body of all that with labels of layers and regions.
SimplexMesh<4> labeled_cube() {
    SimplexMesh<4> mesh = simulator::test::cube<4>(2);
    for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
        mesh.layers.push_back(static_cast<std::uint32_t>(mesh.positions(3, v) / 0.25 + 0.5));
        mesh.columns.push_back(static_cast<std::uint32_t>(v % 27));
    }
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        mesh.regions.push_back(static_cast<std::uint16_t>(cell % 5));
    }
    return mesh;
}

TEST(RunOfMuscles, ResumesToTheSameBytesAndReportsRegionsAndWork) {
    const TempFolder folder;
    write_mesh(folder / "a.pent", labeled_cube());
    std::string text(kScene);
    text.replace(text.find("first = 0"), 9, "first = 0, last = 1");
    const Scene scene = parse_scene(text, "s.toml", folder.path());
    const RunReport whole = run(scene, {.folder = folder / "whole", .threads = 2});
    ASSERT_EQ(whole.verdict, RunVerdict::Finished) << whole.message;
    EXPECT_EQ(read_report(folder / "whole/report.json").bodies.at(0).regions,
              (std::vector<std::string>{"bone", "skin"}));
    double work = 0;
    for (const StepReport& step : whole.steps) {
        ASSERT_EQ(step.regions.size(), 2);
        EXPECT_GT(step.regions[0].energy, 0);
        EXPECT_LT(step.regions[0].energy + step.regions[1].energy, step.energies.of("elastic"));
        work += std::abs(step.activation_work);
    }
    EXPECT_GT(work, 0);
    for (int stop = 1; stop < 6; ++stop) {
        const fs::path cut = folder / ("cut" + std::to_string(stop));
        int steps = stop;
        static_cast<void>(run(scene, {.folder = cut},
                              {.should_stop = [&] { return steps-- == 0; }, .on_frame = {}}));
        const RunReport resumed = run(scene, {.folder = cut, .resume = true});
        EXPECT_EQ(read_text(cut / "frames/a_000006.pent", ""),
                  read_text(folder / "whole/frames/a_000006.pent", ""))
            << stop;
        ASSERT_EQ(resumed.steps.size(), whole.steps.size());
        for (std::size_t i = 0; i < whole.steps.size(); ++i) {
            EXPECT_EQ(resumed.steps[i].activation_work, whole.steps[i].activation_work);
            EXPECT_EQ(resumed.steps[i].regions.at(1).energy, whole.steps[i].regions.at(1).energy);
        }
    }
}

TEST(Explain, ListsEveryActivationAndTheRegions) {
    const TempFolder folder;
    write_mesh(folder / "a.pent", labeled_cube());
    Scene scene = parse_scene(kScene, "s.toml", folder.path());
    const std::string text = explanation_text(explain(scene, 1));
    expect_contains(text,
                    {"2 regions of their own", "activation of a",
                     "fibers constant, to 0.75 of the length at rest, volume preserved, pulses"
                     " of 3 Hz",
                     "fibers distance, to 1.2", "growth, to 1.1"});
    scene.activations.clear();
    expect_contains(explanation_text(explain(scene, 1)), {"no [[activation]]"});
}

}  // namespace
}  // namespace pent::runs
