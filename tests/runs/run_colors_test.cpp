#include "simulator/scenes.h"
#include "support/extras.h"
#include "support/kuhn_box.h"
#include "support/temp_folder.h"

#include <pent/runs/run.h>
#include <pent/viewer/attributes.h>
#include <pent/viewer/coloring.h>
#include <pent/viewer/run_folder.h>

#include <gtest/gtest.h>

#include <string>

// What viewers show of the quantities of a scene's mesh when they look at the run.

namespace pent::viewer {
namespace {

namespace scenes = simulator::test;

template <int Dim>
Eigen::VectorXd colors_of(const std::filesystem::path& path, const std::string& name) {
    const RunFolder run = open_run(path);
    const Body<Dim> body = load_bodies<Dim>(run)[0];
    return vertex_values<Dim>(body, load_frame<Dim>(run, body, 0), coloring_of(name));
}

template <int Dim>
void expect_colors_of_the_mesh() {
    const test::TempFolder folder;
    std::array<int, Dim> count{};
    count.fill(2);
    std::array<double, Dim> size{};
    size.fill(0.5);
    const SimplexMesh<Dim> mesh = test::kuhn_box<Dim>(count, size);
    MeshExtras<Dim> extras = test::all_extras(mesh);
    extras.vertex_fields.push_back(
        {"energy_density", Eigen::MatrixXd::Constant(1, mesh.vertex_count(), 7)});
    write_mesh(folder / "a.pent", mesh, {}, extras);
    simulator::Scene scene = scenes::box_scene<Dim>();
    scene.frames = 1;
    scene.bodies[0].mesh = (folder / "a.pent").string();
    static_cast<void>(runs::run(scene, {.folder = folder / "run"}));
    for (const char* name : {"temperature", "current", "salt", "flow", "age", "energy_density"}) {
        EXPECT_EQ(colors_of<Dim>(folder / "run", name), colors_of<Dim>(folder / "a.pent", name));
        EXPECT_GT(colors_of<Dim>(folder / "run", name).norm(), 0);
    }
    // What a frame says itself goes before what the mesh does: at rest there is no energy.
    scene.output.vertex = {simulator::VertexQuantity::EnergyDensity};
    static_cast<void>(runs::run(scene, {.folder = folder / "own"}));
    EXPECT_LT(colors_of<Dim>(folder / "own", "energy_density").norm(), 1e-9);
}

TEST(RunColors, AtTheStartAreThoseOfTheMeshOfTheScene) {
    expect_colors_of_the_mesh<3>();
    expect_colors_of_the_mesh<4>();
}

}  // namespace
}  // namespace pent::viewer
