#include "mpi_scenes.h"
#include "support/extras.h"
#include "support/messages.h"

#include <cmath>

namespace pent {
namespace {

using test::all_extras;
using test::expect_contains;
using test::expect_same;
using test::kuhn_box;
using test::Outcome;
using test::text_of;

using MpiRuns = test::MpiScenes;

// Of a file behind its header, in which programs have their names.
std::string data_of(const std::string& bytes) {
    return bytes.substr(bytes.find("end_header"));
}

TEST_F(MpiRuns, GoWherePentSimGoes) {
    ASSERT_EQ(simulate(0, "bar", "alone").exit_code, 0);
    ASSERT_EQ(simulate(0, "boxes", "boxes_alone").exit_code, 0);
    for (int ranks = 1; ranks <= 4; ++ranks) {
        const std::string run = "bar" + std::to_string(ranks);
        const Outcome bar = simulate(ranks, "bar", run);
        ASSERT_EQ(bar.exit_code, 0) << bar.err;
        expect_contains(bar.out, {"finished: 5 frames"});
        expect_near<4>(run, "alone", "bar", 1, 1e-6);
        expect_near<4>(run, "alone", "bar", 4, 1e-5);
        const std::string both = "boxes" + std::to_string(ranks);
        const Outcome boxes = simulate(ranks, "boxes", both);
        ASSERT_EQ(boxes.exit_code, 0) << boxes.err;
        for (const char* body : {"a", "b"}) {
            expect_near<3>(both, "boxes_alone", body, 1, 1e-6);
            // Penalties have kinks, at which Newton's method ends where it comes to first.
            expect_near<3>(both, "boxes_alone", body, 4, 1e-2);
        }
        const runs::RunReport own = report(both);
        const runs::RunReport alone = report("boxes_alone");
        ASSERT_EQ(own.steps.size(), alone.steps.size());
        EXPECT_EQ(own.parts.back().ranks, ranks);
        EXPECT_EQ(alone.parts.back().ranks, 0);
        for (std::size_t i = 0; i < own.steps.size(); ++i) {
            EXPECT_EQ(own.steps[i].contact.point_facet, alone.steps[i].contact.point_facet);
            EXPECT_EQ(own.steps[i].contact.obstacle, alone.steps[i].contact.obstacle);
            const double energy = alone.steps[i].energies.total();
            EXPECT_NEAR(own.steps[i].energies.total(), energy, 1e-3 * std::abs(energy));
        }
        EXPECT_GT(alone.steps.back().contact.point_facet, 0);
    }
}

// Each rank writes a slab. Before the first step the state is the same to the bit on any ranks.
TEST_F(MpiRuns, WriteTheFramesThatPentSimWrites) {
    std::string text = kBoxes;
    text.replace(text.find("frames = 4"), 10, "frames = 1");
    write("start",
          text + "[output]\nvertex = [\"contact_force\", \"reaction\", \"energy_density\"]\n");
    ASSERT_EQ(simulate(0, "start", "alone").exit_code, 0);
    for (const int ranks : {1, 2, 3, 4}) {
        const std::string run = "start" + std::to_string(ranks);
        const Outcome outcome = simulate(ranks, "start", run);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        for (const char* body : {"a", "b"}) {
            const FileInfo own = read_info(frame(run, body, 0));
            const FileInfo alone = read_info(frame("alone", body, 0));
            EXPECT_EQ(own.crc32c, alone.crc32c) << ranks << " " << body;
            EXPECT_EQ(own.vertices, alone.vertices);
            const auto file = read_frame<3>(frame(run, body, 0));
            EXPECT_EQ(file.contact_forces.cols(), file.positions.cols());
            EXPECT_EQ(file.fields.size(), 2U);
        }
    }
}

TEST_F(MpiRuns, AreTheSameToTheBitForAnyThreadsRunAfterRun) {
    for (const int ranks : {2, 3}) {
        const std::string name = "threads" + std::to_string(ranks);
        ASSERT_EQ(simulate(ranks, "bar", name + "a", "--threads 1").exit_code, 0);
        ASSERT_EQ(simulate(ranks, "bar", name + "b", "--threads 2").exit_code, 0);
        ASSERT_EQ(simulate(ranks, "bar", name + "c", "--threads 3").exit_code, 0);
        expect_same_bytes(name + "a", name + "b", "bar");
        expect_same_bytes(name + "a", name + "c", "bar");
    }
}

// 80 boxes that share no link: more than every rank factors, so that PETSc has the coarsest level.
TEST_F(MpiRuns, OfManyPiecesGoWherePentSimGoesAndAreTheSameRunAfterRun) {
    const SimplexMesh<3> box = kuhn_box<3>({1, 1, 1}, {0.2, 0.3, 0.2});
    const Eigen::Index corners = box.vertex_count();
    constexpr Eigen::Index kPieces = 80;
    SimplexMesh<3> pieces;
    pieces.positions.resize(3, kPieces * corners);
    pieces.cells.resize(4, kPieces * box.cell_count());
    for (Eigen::Index i = 0; i < kPieces; ++i) {
        pieces.positions.middleCols(i * corners, corners) =
            box.positions.colwise()
            + Eigen::Vector3d(0.5 * static_cast<double>(i % 9), 0, 0.4 * static_cast<double>(i));
        pieces.cells.middleCols(i * box.cell_count(), box.cell_count()) =
            box.cells.array() + static_cast<std::uint32_t>(i * corners);
    }
    static_cast<void>(write_mesh(path("pieces.pent"), pieces));
    write("pieces", R"([scene]
dimension = 3
gravity = [0, -9.8, 0]
frames = 4

[[body]]
name = "pieces"
mesh = "pieces.pent"
material = { young = 1e5 }

[[constraint]]
body = "pieces"
select = { half_space = { normal = [0, 1, 0], offset = 1e-6 } }
motion = { rotate = [{ plane = "zx", degrees_per_s = 60 }] }

[solver]
tolerance = 1e-8
precision = "double"
)");
    ASSERT_EQ(simulate(0, "pieces", "alone").exit_code, 0);
    for (const char* run : {"first", "second"}) {
        const Outcome outcome = simulate(3, "pieces", run);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        expect_near<3>(run, "alone", "pieces", 4, 1e-5);
    }
    expect_same_bytes("first", "second", "pieces");
}

// With the same ranks to the bit; else as near as other ranks are.
TEST_F(MpiRuns, GoOnByAsManyRanksByOthersAndByPentSim) {
    ASSERT_EQ(simulate(2, "bar", "whole").exit_code, 0);
    std::string cut = kBar;
    cut.replace(cut.find("frames = 4"), 10, "frames = 2");
    write("cut", cut);
    for (const int ranks : {2, 3, 0}) {
        const std::string run = "from" + std::to_string(ranks);
        ASSERT_EQ(simulate(2, "cut", run).exit_code, 0);
        const Outcome resumed = simulate(ranks, "bar", run, "--resume");
        ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
        expect_contains(resumed.out, {"it goes on from frame 2"});
        EXPECT_EQ(resumed.out.find("run by 2 ranks") != std::string::npos, ranks != 2)
            << resumed.out;
        if (ranks == 2) {
            expect_same_bytes("whole", run, "bar");
        }
        expect_near<4>(run, "whole", "bar", 4, 1e-5);
        EXPECT_EQ(report(run).parts.size(), 2U);
    }
}

// A mesh, and base and layers that make it: with regions, holds, contact and layers that turn.
TEST_F(MpiRuns, OfBaseAndLayersAreThoseOfTheMesh) {
    write_extrusion_and_mesh();
    for (const std::string mesh : {"base", "whole"}) {
        write(mesh, twins(mesh));
    }
    for (const int ranks : {0, 1, 2, 3}) {
        for (const std::string mesh : {"base", "whole"}) {
            const Outcome run = simulate(ranks, mesh, mesh + std::to_string(ranks));
            ASSERT_EQ(run.exit_code, 0) << run.err;
        }
        const std::string base = "base" + std::to_string(ranks);
        const std::string whole = "whole" + std::to_string(ranks);
        for (const char* body : {"a", "b"}) {
            expect_same_bytes(base, whole, body);
            EXPECT_EQ(text_of(path(base + "/meshes/" + body + ".pent")),
                      text_of(path(whole + "/meshes/" + body + ".pent")));
        }
        EXPECT_GT(report(base).steps.back().contact.point_facet, 0);
    }
    // A run goes on with the other kind of file.
    const Outcome resumed = simulate(2, "whole", "base2", "--resume");
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
}

// No rank has a whole mesh: each reads slabs of a file and keeps the cells that it needs, or
// extrudes these, with their labels, and writes a slab.
TEST_F(MpiRuns, InWhichNoRankHasAWholeMeshAreThoseOfOne) {
    write_extrusion_and_mesh();
    static_cast<void>(write_mesh(path("text.pent"), read_mesh<4>(path("whole.pent")).mesh,
                                 {.encoding = Encoding::Ascii}));
    for (const std::string mesh : {"base", "whole", "text"}) {
        write(mesh, twins(mesh));
    }
    ASSERT_EQ(simulate(0, "whole", "alone").exit_code, 0);
    for (const int ranks : {2, 3}) {
        const std::string number = std::to_string(ranks);
        for (const std::string mesh : {"base", "whole", "text"}) {
            const Outcome run = simulate(ranks, mesh, mesh + number);
            ASSERT_EQ(run.exit_code, 0) << run.err;
            for (const std::string body : {"a", "b"}) {
                expect_same_bytes(mesh + number, "base" + number, body);
                const std::string file = "/meshes/" + body + ".pent";
                EXPECT_EQ(data_of(text_of(path(mesh + number + file))),
                          data_of(text_of(path("alone" + file))));
            }
        }
    }
    EXPECT_GT(report("base3").steps.back().contact.point_facet, 0);
}

// Quantities, labels and tags of the mesh file, of a body that is turned, too.
TEST_F(MpiRuns, HaveWhatIsBesideTheMeshAsPentSimHasIt) {
    write_extrusion_and_mesh();
    const SimplexMesh<4> mesh = read_mesh<4>(path("whole.pent")).mesh;
    std::string scene = twins("rich");
    scene.replace(scene.find("frames = 4"), 10, "frames = 1");
    scene.replace(scene.find("translate = [0.05, 0.415"), 24,
                  "rotate = [{ plane = \"zw\", degrees = 40 }], translate = [0.05, 2");
    write("rich", scene);
    for (const Encoding encoding : {Encoding::Binary, Encoding::Ascii}) {
        static_cast<void>(
            write_mesh(path("rich.pent"), mesh, {.encoding = encoding}, all_extras(mesh)));
        for (const int ranks : {0, 1, 2, 3}) {
            const std::string run = "rich" + std::to_string(ranks);
            const Outcome outcome = simulate(ranks, "rich", run, "--force");
            ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
            for (const std::string file : {"/meshes/a.pent", "/meshes/b.pent"}) {
                EXPECT_EQ(data_of(text_of(path(run + file))),
                          data_of(text_of(path("rich0" + file))));
            }
        }
        expect_same(read_mesh<4>(path("rich3/meshes/a.pent")).extras, all_extras(mesh));
        EXPECT_NE(read_mesh<4>(path("rich3/meshes/b.pent")).extras.cell_fields,
                  all_extras(mesh).cell_fields);
        // By others, with other quantities: none of them are of the run.
        static_cast<void>(
            write_mesh(path("rich.pent"), mesh, {.encoding = encoding}, all_extras(mesh, 2)));
        for (const int ranks : {0, 2}) {
            const Outcome resumed = simulate(ranks, "rich", "rich3", "--resume");
            EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
        }
    }
}

// Cells around edges reach a cell farther, in a file and over the base of layers.
TEST_F(MpiRuns, OfSmoothedElementsAreThoseOfTheMesh) {
    write_extrusion_and_mesh();
    for (const std::string mesh : {"base", "whole"}) {
        std::string scene = twins(mesh);
        scene.replace(scene.find("frames = 4"), 10, "frames = 1");
        const std::size_t contact = scene.find("[contact]");  // penalties have kinks
        scene.erase(contact, scene.find("[solver]") - contact);
        write(mesh, scene + "newton_tolerance = 1e-7\nelements = \"smoothed\"\n");
    }
    ASSERT_EQ(simulate(0, "whole", "alone").exit_code, 0);
    for (const int ranks : {2, 3}) {
        const std::string number = std::to_string(ranks);
        for (const std::string mesh : {"base", "whole"}) {
            const Outcome run = simulate(ranks, mesh, mesh + number);
            ASSERT_EQ(run.exit_code, 0) << run.err;
        }
        for (const std::string body : {"a", "b"}) {
            EXPECT_EQ(text_of(frame("base" + number, body, 1)),
                      text_of(frame("whole" + number, body, 1)));
            expect_near<4>("whole" + number, "alone", body, 1, 1e-6);
        }
    }
}

// Fibers of cells that ranks have in part, and ties to cells that another rank has.
TEST_F(MpiRuns, OfFibersAndAttachmentsGoWherePentSimGoes) {
    SimplexMesh<4> mesh = kuhn_box<4>({4, 2, 1, 2}, {0.6, 0.4, 0.2, 0.4});
    mesh.fibers.resize(4, mesh.cell_count());
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        mesh.regions.push_back(cell % 3 == 1 ? 7 : 3);
        mesh.fibers.col(cell) << 1, 0.1 * static_cast<double>(cell % 7), 0, 0.2;
    }
    static_cast<void>(write_mesh(path("fibers.pent"), mesh));
    std::string scene = twins("fibers");
    const std::size_t contact = scene.find("[contact]");
    scene.replace(contact, scene.find("[solver]") - contact, R"([[activation]]
body = "a"
select = { region = 7 }
stretch = 0.9
fibers = "mesh"

[[attachment]]
body = "b"
target = "a"
select = { half_space = { normal = [0, 1, 0, 0], offset = 0.42 } }
stiffness = 10
max_distance = 0.5

)");
    scene.replace(scene.find("offset = -0.2"), 13, "offset = 1e-6");
    write("muscle", scene + "newton_tolerance = 1e-7\n");
    const Outcome alone = simulate(0, "muscle", "alone");
    ASSERT_EQ(alone.exit_code, 0) << alone.err;
    for (const int ranks : {1, 2, 3, 4}) {
        const std::string run = "on" + std::to_string(ranks);
        const Outcome outcome = simulate(ranks, "muscle", run);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        for (const std::string body : {"a", "b"}) {
            expect_near<4>(run, "alone", body, 1, 1e-6);
            expect_near<4>(run, "alone", body, 4, 1e-5);
        }
    }
}

// Of quadratic cells a rank keeps those that have a node of its own, with all of their children.
TEST_F(MpiRuns, OfQuadraticElementsGoWherePentSimGoes) {
    static_cast<void>(write_mesh(path("parents.pent"),
                                 test::quadratic_kuhn_box<4>({3, 1, 1, 1}, {1.5, 0.5, 0.5, 0.5})));
    std::string scene = kBar;
    scene.replace(scene.find("bar.pent"), 3, "parents");
    write("quadratic", scene + "elements = \"quadratic\"\n");
    ASSERT_EQ(simulate(0, "quadratic", "alone").exit_code, 0);
    for (const int ranks : {1, 2, 3, 4}) {
        const std::string run = "of" + std::to_string(ranks);
        const Outcome outcome = simulate(ranks, "quadratic", run);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        expect_near<4>(run, "alone", "bar", 1, 1e-6);
        expect_near<4>(run, "alone", "bar", 4, 1e-5);
        EXPECT_EQ(read_info(path(run + "/meshes/bar.pent")).crc32c,
                  read_info(path("alone/meshes/bar.pent")).crc32c);
    }
}

// All is held, by grips that part: strained elements, of which each rank has some and shares some.
TEST_F(MpiRuns, OfHeldElementsHaveTheForcesOfPentSim) {
    const std::string half = R"(
[[constraint]]
body = "bar"
select = { half_space = { normal = [)";
    for (const std::string kind : {"linear", "smoothed"}) {
        std::string scene = kBar;
        scene.erase(scene.find("[[constraint]]"));
        write(kind,
              scene + half + "1, 0, 0, 0], offset = 0.8 } }\n" + half
                  + "-1, 0, 0, 0], offset = -0.9 } }\nmotion = { translate = [0.5, 0, 0, 1] }\n"
                  + "[solver]\nelements = \"" + kind + "\"\n");
        ASSERT_EQ(simulate(0, kind, kind + "0").exit_code, 0);
        const runs::RunReport alone = report(kind + "0");
        const double force = alone.steps.back().constraints[1].force[0];
        EXPECT_GT(force, 0);
        for (const int ranks : {1, 2, 3, 4}) {
            const std::string run = kind + std::to_string(ranks);
            const Outcome outcome = simulate(ranks, kind, run);
            ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
            const runs::RunReport own = report(run);
            ASSERT_EQ(own.steps.size(), alone.steps.size());
            for (std::size_t i = 0; i < own.steps.size(); ++i) {
                const double energy = alone.steps[i].energies.of("elastic");
                EXPECT_GT(energy, 0);
                EXPECT_NEAR(own.steps[i].energies.of("elastic"), energy, 1e-12 * energy);
                EXPECT_NEAR(own.steps[i].constraints[1].force[0],
                            alone.steps[i].constraints[1].force[0], 1e-12 * force);
            }
        }
    }
}

// By checksums, of which each rank finds a part.
TEST_F(MpiRuns, GoOnWithTheSameMeshesAlone) {
    const std::string mesh = "run/meshes/bar.pent";
    ASSERT_EQ(simulate(2, "bar", "run").exit_code, 0);
    const std::string good = text_of(path(mesh));
    for (const int ranks : {0, 3}) {
        SimplexMesh<4> other = read_mesh<4>(path("bar.pent")).mesh;
        std::swap(other.layers.front(), other.layers.back());
        static_cast<void>(write_mesh(path(mesh), other));
        Outcome resumed = simulate(ranks, "bar", "run", "--resume");
        EXPECT_EQ(resumed.exit_code, 1);
        expect_contains(resumed.err, {"bar.pent: is another mesh than that of the scene now"});
        std::string damaged = good;
        damaged[damaged.size() - 100] ^= 1;
        std::ofstream(path(mesh), std::ios::binary) << damaged;
        resumed = simulate(ranks, "bar", "run", "--resume");
        EXPECT_EQ(resumed.exit_code, 1);
        expect_contains(resumed.err, {"bar.pent: checksum", "changed after it was written"});
        std::ofstream(path(mesh), std::ios::binary) << good;
        EXPECT_EQ(simulate(ranks, "bar", "run", "--resume").exit_code, 0);
    }
}

// Open MPI gives a rank a terminal, whatever becomes of what it says.
TEST_F(MpiRuns, SayHowFarTheyAreInPlainLines) {
    const Outcome run = simulate(2, "bar", "run");
    EXPECT_EQ(run.exit_code, 0);
    expect_contains(run.out, {" left"});
    EXPECT_EQ(run.out.find('\x1b'), std::string::npos) << run.out;
}

TEST_F(MpiRuns, SayTheirHelpOnce) {
    const Outcome help = test::run_program("pent-sim-mpi --help", test::mpirun(3));
    EXPECT_EQ(help.exit_code, 0);
    const std::string line = "Replace a run that is in the folder";
    EXPECT_NE(help.out.find(line), std::string::npos);
    EXPECT_EQ(help.out.find(line), help.out.rfind(line));
    const Outcome version = test::run_program("pent-sim-mpi --version");
    expect_contains(version.out, {"pent-sim-mpi", "distributed"});
}

}  // namespace
}  // namespace pent
