#include "run/run_meshes.h"

#include "simulator/cut_meshes.h"
#include "simulator/scenes.h"
#include "simulator/thread_ranks.h"
#include "support/fork.h"
#include "support/temp_folder.h"

#include <pent/pent_file.h>
#include <pent/runs/explain.h>
#include <pent/simulator/mesh_parts.h>

#include <gtest/gtest.h>

namespace pent::runs {
namespace {

namespace test = simulator::test;
using pent::test::TempFolder;

// Held at x = 0, with fibers away from there, tied to where it is, by labels of its cells.
Scene muscle(const TempFolder& folder) {
    SimplexMesh<4> mesh = pent::test::fork<4>();
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        mesh.regions.push_back(static_cast<std::uint16_t>(cell % 7));
    }
    static_cast<void>(write_mesh(folder / "fork.pent", mesh));
    Scene scene = test::box_scene<4>();
    scene.bodies[0].mesh = (folder / "fork.pent").string();
    scene.constraints = {test::hold(test::left_end(), test::still(4))};
    scene.activations = {{.body = "box",
                          .select = {simulator::RegionSelection{.region = 2}},
                          .stretch = 0.9,
                          .fibers = simulator::Fibers::Distance,
                          .away_from = {test::left_end()}}};
    Attachment tie;
    tie.body = "box";
    tie.select = {simulator::RegionSelection{.region = 3}};
    tie.stiffness = 20;
    scene.attachments = {tie};
    return scene;
}

// Runs and --explain read meshes in this one way: whatever a scene asks for, a rank has the cells
// that it needs, and the simulation no mesh.
TEST(RunMeshes, AreOnNoRankWhole) {
    const TempFolder folder;
    const Scene scene = muscle(folder);
    const SimplexMesh<4> whole = read_mesh<4>(scene.bodies[0].mesh).mesh;
    test::on_ranks(3, [&](const std::shared_ptr<const simulator::Ranks>& ranks) {
        const RunRanks together(ranks.get());
        RunMeshes<4> meshes(scene, together);
        int looks = 0;
        const Simulation<4> simulation =
            meshes.simulate({.ranks = ranks}, [&](std::size_t body, const LoadedMesh<4>& mesh) {
                EXPECT_EQ(body, 0);
                EXPECT_EQ(mesh.cells, whole.cell_count());
                EXPECT_FALSE(mesh.has_parents);
                EXPECT_EQ(mesh.share.mesh.cell_count(),
                          test::cut_meshes<4>(scene, {whole}, *ranks)[0].mesh.cell_count());
                EXPECT_LT(mesh.share.mesh.cell_count(), whole.cell_count());
                ++looks;
            });
        EXPECT_EQ(looks, 1);
        EXPECT_EQ(simulation.mesh(0).cell_count(), 0);
    });
}

TEST(RunMeshes, AreWholeForAProgramOnItsOwn) {
    const TempFolder folder;
    const Scene scene = muscle(folder);
    const RunRanks alone(nullptr);
    RunMeshes<4> meshes(scene, alone);
    const Simulation<4> simulation =
        meshes.simulate({}, [&](std::size_t /*body*/, const LoadedMesh<4>& mesh) {
            EXPECT_EQ(mesh.cells, mesh.share.mesh.cell_count());
        });
    EXPECT_GT(simulation.mesh(0).cell_count(), 0);
}

TEST(Explain, IsTheSameOnRanksButForCosts) {
    const TempFolder folder;
    const Scene scene = muscle(folder);
    const Explanation alone = explain(scene, 1);
    for (const int count : {1, 2, 4}) {
        test::on_ranks(count, [&](const std::shared_ptr<const simulator::Ranks>& ranks) {
            const Explanation own = explain(scene, 1, ranks);
            EXPECT_EQ(own.advice, alone.advice);
            EXPECT_EQ(own.unknowns, alone.unknowns);
            ASSERT_EQ(own.terms.size(), alone.terms.size() + 1);
            EXPECT_EQ(own.terms.back().name, "ranks");
            for (std::size_t i = 0; i < alone.terms.size(); ++i) {
                EXPECT_EQ(own.terms[i].name, alone.terms[i].name);
                EXPECT_EQ(own.terms[i].is_on, alone.terms[i].is_on);
                EXPECT_EQ(own.terms[i].unknowns, alone.terms[i].unknowns);
                if (own.terms[i].name != "linear solver") {  // which has its iterations
                    EXPECT_EQ(own.terms[i].why, alone.terms[i].why);
                }
            }
        });
    }
}

}  // namespace
}  // namespace pent::runs
