#include "run/run_meshes.h"

#include "simulator/cut_meshes.h"
#include "simulator/scenes.h"
#include "simulator/thread_ranks.h"
#include "support/extras.h"
#include "support/file_bytes.h"
#include "support/fork.h"
#include "support/messages.h"
#include "support/misfits.h"
#include "support/temp_folder.h"

#include <pent/mesh_extras.h>
#include <pent/mesh_part.h>
#include <pent/pent_file.h>
#include <pent/runs/explain.h>
#include <pent/simulator/mesh_parts.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace pent::runs {
namespace {

namespace test = simulator::test;
using pent::test::bytes_of;
using pent::test::expect_contains;
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
    scene.bodies[0].source = "scene.toml:3:1";
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

// What reading meshes into a simulation leads to. No rank but one alone has all cells of any.
template <int Dim>
std::string outcome_of(const Scene& scene, const std::shared_ptr<const simulator::Ranks>& ranks) {
    const RunRanks together(ranks.get());
    RunMeshes<Dim> meshes(scene, together);
    try {
        const Simulation<Dim> simulation = meshes.simulate(
            {.ranks = ranks}, [&](std::size_t /*body*/, const LoadedMesh<Dim>& mesh) {
                if (together.count() > 1) {
                    EXPECT_LT(mesh.share.mesh.cell_count(), mesh.cells);
                }
            });
    } catch (const Error& error) {
        return error.what();
    }
    std::string lines = "warnings:";
    for (const std::string& line : meshes.warnings()) {
        lines += " " + line;
    }
    return lines;
}

template <int Dim>
std::string outcome_of_all(const Scene& scene) {
    std::string alone = outcome_of<Dim>(scene, nullptr);
    for (const int count : {1, 2, 3, 4}) {
        test::on_ranks(count, [&](const std::shared_ptr<const simulator::Ranks>& ranks) {
            EXPECT_EQ(outcome_of<Dim>(scene, ranks), alone);
        });
    }
    return alone;
}

// A scene of a sound mesh and one that is not, in both kinds of files, and with contact.
template <int Dim>
void expect_misfit(const SimplexMesh<Dim>& mesh, const std::string& what) {
    const TempFolder folder;
    static_cast<void>(write_mesh(folder / "sound.pent", pent::test::fork<Dim>()));
    static_cast<void>(write_mesh(folder / "misfit.pent", mesh));
    static_cast<void>(write_mesh(folder / "text.pent", mesh, {.encoding = Encoding::Ascii}));
    Scene scene = test::box_scene<Dim>();
    scene.bodies[0].mesh = (folder / "sound.pent").string();
    scene.bodies[0].source = "scene.toml:3:1";
    scene.bodies.push_back(scene.bodies[0]);
    scene.bodies[1].name = "second";
    for (const char* name : {"misfit.pent", "text.pent"}) {
        scene.bodies[1].mesh = (folder / name).string();
        scene.contact = ContactSettings{};
        const std::string error = outcome_of_all<Dim>(scene);
        scene.contact.reset();
        const std::string warning = outcome_of_all<Dim>(scene);
        const std::string line =
            "warnings: " + scene.bodies[1].mesh + ": its cells do not fit together: ";
        EXPECT_EQ(warning.substr(0, line.size()), line);
        expect_contains(warning, {what});
        expect_contains(error, {what, "contact needs a closed surface"});
    }
}

template <int Dim>
void expect_misfits() {
    const std::string overfull = " of its facets have more than two cells";
    const SimplexMesh<Dim> fork = pent::test::fork<Dim>();
    const Eigen::Index cells = fork.cell_count();
    const Eigen::Index facets = match_facets<Dim>(fork.cells, fork.vertex_count()).boundary.cols();
    for (const double place : {0.0, 0.5, 1.0}) {
        const auto cell = static_cast<Eigen::Index>(place * static_cast<double>(cells - 1));
        const auto facet = static_cast<Eigen::Index>(place * static_cast<double>(facets - 1));
        expect_misfit(pent::test::with_cells_twice(fork, {cell}), overfull);
        expect_misfit(pent::test::with_cells_on_one_side(fork, {facet}),
                      "1 of its facets have both cells on one side");
    }
    std::vector<Eigen::Index> many;
    for (Eigen::Index cell = cells / 3; cell < cells; cell += 5) {
        many.push_back(cell);
    }
    expect_misfit(pent::test::with_cells_twice(fork, many), overfull);
    expect_misfit(pent::test::with_cells_on_one_side(
                      pent::test::with_cells_twice(fork, {cells / 2}), {facets / 3, facets / 2}),
                  overfull);
}

TEST(RunMeshes, OfCellsThatDoNotFitAreJudgedByRanksAsByOne) {
    expect_misfits<3>();
    expect_misfits<4>();
}

// Before what is held twice, of all bodies.
TEST(RunMeshes, AreJudgedInTheOrderOfOneProcess) {
    const TempFolder folder;
    Scene scene = muscle(folder);
    scene.activations.clear();
    scene.attachments.clear();
    scene.constraints.push_back(scene.constraints[0]);
    const std::string held = "is held by two constraints at one time";
    expect_contains(outcome_of_all<4>(scene), {held});
    static_cast<void>(write_mesh(folder / "twice.pent",
                                 pent::test::with_cells_twice(pent::test::fork<4>(), {0})));
    scene.bodies.push_back(scene.bodies[0]);
    scene.bodies[1].name = "second";
    scene.bodies[1].mesh = (folder / "twice.pent").string();
    expect_contains(outcome_of_all<4>(scene), {held});
    scene.contact = ContactSettings{};
    expect_contains(outcome_of_all<4>(scene), {"twice.pent: its cells do not fit together"});
}

TEST(RunMeshes, ThatMakeNoQuadraticElementsAreRefusedByRanksAsByOne) {
    const TempFolder folder;
    Scene scene = test::box_scene<4>();
    scene.solver.elements = simulator::ElementKind::Quadratic;
    scene.bodies[0].mesh = (folder / "a.pent").string();
    scene.bodies[0].source = "scene.toml:3:1";
    const auto outcome = [&](const SimplexMesh<4>& mesh) {
        static_cast<void>(write_mesh(folder / "a.pent", mesh));
        return outcome_of_all<4>(scene);
    };
    SimplexMesh<4> mesh = pent::test::quadratic_kuhn_box<4>({5, 1, 1, 1}, {2.5, 0.5, 0.5, 0.5});
    EXPECT_EQ(outcome(mesh), "warnings:");
    expect_contains(outcome(pent::test::fork<4>()), {"no multiple of 16"});
    expect_contains(outcome(test::bar(10)), {"cell 0 and 15 more"});
    mesh.parents.back() = 4000;
    expect_contains(outcome(mesh), {"parent ", "with 15 cells"});
    mesh.parents.clear();
    expect_contains(outcome(mesh), {"cell 0 and 15 more"});
}

// Inverted cells: the lowest of the mesh is named, whichever ranks have them.
TEST(RunMeshes, ThatAreNoneAreRefusedByRanksAsByOne) {
    const TempFolder folder;
    const Scene scene = muscle(folder);
    SimplexMesh<4> mesh = pent::test::fork<4>();
    for (const Eigen::Index cell :
         {mesh.cell_count() - 1, mesh.cell_count() / 2, Eigen::Index{1}}) {
        std::swap(mesh.cells(0, cell), mesh.cells(1, cell));
        static_cast<void>(write_mesh_slab(folder / "fork.pent", mesh, {}, {}));
        expect_contains(outcome_of_all<4>(scene),
                        {"pentachoron " + std::to_string(cell) + ": inverted"});
    }
}

// Files that are not as they were written, or that cannot have been.
TEST(RunMeshes, OfFilesWithFaultsAreRefusedByRanksAsByOne) {
    const TempFolder folder;
    const Scene scene = muscle(folder);
    const SimplexMesh<4> mesh = pent::test::fork<4>();
    const std::string file = folder / "fork.pent";
    SimplexMesh<4> endless = mesh;
    endless.positions(2, 7) = std::numeric_limits<double>::infinity();
    for (const Encoding encoding : {Encoding::Binary, Encoding::Ascii}) {
        static_cast<void>(write_mesh_slab(file, endless, {}, {.encoding = encoding}));
        expect_contains(outcome_of_all<4>(scene), {"fork.pent: vertex 7: z is inf"});
        static_cast<void>(write_mesh(file, mesh, {.encoding = encoding}));
        std::string bytes = bytes_of(file);
        bytes[bytes.size() - 4] ^= 1;
        std::ofstream(file, std::ios::binary) << bytes;
        expect_contains(outcome_of_all<4>(scene), {"checksum"});
        bytes.resize(bytes.size() - 9);
        std::ofstream(file, std::ios::binary) << bytes;
        expect_contains(outcome_of_all<4>(scene), {"scene.toml:3:1: ", "fork.pent: "});
    }
    std::string text = bytes_of(file);
    text[text.size() - 40] = 'x';
    std::ofstream(file, std::ios::binary) << text;
    expect_contains(outcome_of_all<4>(scene), {"fork.pent: pentachoron "});
}

// Quantities and labels beside the mesh, two wrong at a time, behind a sound mesh and one that is
// none: what pent-check says of the file, though a simulation needs none of them.
TEST(RunMeshes, WithFaultsBesideThemAreRefusedByRanksAsByOne) {
    const TempFolder folder;
    const Scene scene = muscle(folder);
    const SimplexMesh<4> mesh = pent::test::fork<4>();
    const MeshExtras<4> sound = pent::test::all_extras(mesh);
    MeshExtras<4> of_vertices = sound;
    of_vertices.vertex_fields[0].values(0, 9) = std::numeric_limits<double>::infinity();
    of_vertices.vertex_fields[1].values(2, 8) = std::numeric_limits<double>::infinity();
    MeshExtras<4> of_cells = sound;
    of_cells.cell_fields[1].values(0, mesh.cell_count() - 1) =
        std::numeric_limits<double>::infinity();
    MeshExtras<4> of_facets = sound;
    of_facets.boundary(1, 2) = 4000;
    const std::vector<std::pair<MeshExtras<4>, std::string>> cases = {
        {of_vertices, "vertex 8: current is not finite"},
        {of_cells, "pentachoron " + std::to_string(mesh.cell_count() - 1) + ": age is not"},
        {of_facets, "boundary 2: vertex 4000 of"}};
    SimplexMesh<4> inverted = mesh;
    std::swap(inverted.cells(0, 3), inverted.cells(1, 3));
    const std::string file = folder / "fork.pent";
    for (const Encoding encoding : {Encoding::Binary, Encoding::Ascii}) {
        for (const auto& [extras, what] : cases) {
            static_cast<void>(write_mesh_slab(file, mesh, extras, {.encoding = encoding}));
            expect_contains(outcome_of_all<4>(scene), {"scene.toml:3:1: ", "fork.pent: ", what});
            static_cast<void>(write_mesh_slab(file, inverted, extras, {.encoding = encoding}));
            expect_contains(outcome_of_all<4>(scene), {"pentachoron 3: inverted"});
        }
        static_cast<void>(write_mesh(file, mesh, {.encoding = encoding}, sound));
        std::string bytes = bytes_of(file);
        bytes[bytes.size() - 2] = encoding == Encoding::Ascii ? 'x' : '\1';
        std::ofstream(file, std::ios::binary) << bytes;
        expect_contains(outcome_of_all<4>(scene),
                        {encoding == Encoding::Ascii ? "base_label is " : "checksum"});
    }
}

TEST(RunMeshes, OfAFrameAreRefusedByRanksAsByOne) {
    const TempFolder folder;
    Scene scene = muscle(folder);
    Frame<4> frame;
    frame.positions = pent::test::fork<4>().positions;
    frame.mesh_name = "fork.pent";
    write_frame(folder / "fork.pent", frame);
    expect_contains(outcome_of_all<4>(scene), {"this is a frame of the mesh fork.pent"});
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
