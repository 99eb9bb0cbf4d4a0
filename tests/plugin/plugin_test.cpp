#include "plugin_client.h"
#include "plugin_scenes.h"
#include "stored_mesh.h"
#include "support/temp_folder.h"

#include <pent/output_file.h>
#include <pent/pent_file.h>
#include <pent/runs/scene_file.h>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <pent_plugin_meshes.h>
#include <string>
#include <vector>

namespace pent {
namespace {

using simulator::Simulation;
using test::closed_c_mesh;
using test::expect_error;
using test::Host;

// Implicit Euler falls by h^2 g n (n + 1) / 2 in n steps, whoever hosts it.
TEST(Plugin, LetsAProgramInCRunAScene) {
    const pent::test::TempFolder folder;
    const SimplexMesh<4> mesh = pent::test::kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 1});
    write_mesh(folder / "box.pent", mesh);
    write_text(folder / "scene.toml",
               "[scene]\ngravity = [0, -9, 0, 0]\n[[body]]\nname = \"box\"\nmesh = \"box.pent\"\n");
    plugin_sight sight{};
    const std::string scene = (folder / "scene.toml").string();
    ASSERT_EQ(drive_plugin(PENT_PLUGIN_PATH, scene.c_str(), 3, &sight), 0);
    EXPECT_EQ(sight.version, PENT_PLUGIN_VERSION);
    EXPECT_EQ(sight.dimension, 4);
    EXPECT_EQ(sight.bodies, 1);
    EXPECT_EQ(sight.vertices, 16);
    EXPECT_EQ(sight.cells, 24);
    EXPECT_EQ(sight.last_step, 0);
    EXPECT_DOUBLE_EQ(sight.time, 0.1);
    EXPECT_NEAR(sight.height, -9.0 / 900 * 6, 1e-5);  // the default tolerance of the solver
    EXPECT_NE(std::string(sight.bad_scene).find("/no/such/scene.toml"), std::string::npos);
    EXPECT_EQ(std::string(sight.bad_body), "body 99 of 1; count from 0");
}

TEST(Plugin, TellsHostsOfVersion1) {
    std::array<char, 512> told{};
    drive_version_1(PENT_PLUGIN_PATH, "scene.toml", told.data(), told.size());
    EXPECT_EQ(std::string(told.data()).find("this host was built for version 1"), 0U)
        << told.data();
    EXPECT_NE(std::string(told.data()).find("pent_open_file()"), std::string::npos);
}

// The simulation that the library would make of the same.
Simulation<4> twin() {
    return {runs::parse_scene(test::kScene4, "scene", ""), {test::box<4>(), test::box<4>()}};
}

void expect_same(const Host& host, const Simulation<4>& simulation) {
    ASSERT_EQ(pent_body_count(host), simulation.body_count());
    for (int body = 0; body < simulation.body_count(); ++body) {
        const auto positions = simulation.positions(body);
        const auto velocities = simulation.velocities(body);
        EXPECT_TRUE(std::equal(positions.data(), positions.data() + positions.size(),
                               pent_positions(host, body)));
        EXPECT_TRUE(std::equal(velocities.data(), velocities.data() + velocities.size(),
                               pent_velocities(host, body)));
    }
}

// Everything that changes something, side by side with the library: the same bits.
TEST(Plugin, DoesWhatTheLibraryDoes) {
    const Host host = test::open4();
    Simulation<4> simulation = twin();
    const auto step = [&] {
        pent_step_report report = {};
        ASSERT_EQ(pent_step(host, &report), 0) << pent_last_error();
        const simulator::StepReport own = simulation.step();
        EXPECT_EQ(report.step, own.step);
        EXPECT_EQ(report.iterations, own.iterations);
        EXPECT_EQ(report.unknowns, own.unknowns);
        EXPECT_EQ(report.obstacle, own.contact.obstacle);
        EXPECT_EQ(report.asleep, own.asleep);
        expect_same(host, simulation);
    };
    step();
    const std::vector<std::uint32_t> vertices = {3, 1};
    const Positions<4> targets = Positions<4>::Constant(4, 2, 0.3);
    ASSERT_EQ(pent_set_targets(host, 1, vertices.data(), 2, targets.data()), 0);
    simulation.set_targets(1, vertices, targets);
    step();
    ASSERT_EQ(pent_release(host, 1, vertices.data(), 1), 0);
    simulation.release(1, {3});
    pent_grab grab = {};
    grab.point.cell = 2;
    grab.point.weights[0] = 0.25;
    grab.point.weights[4] = 0.75;
    grab.anchor[3] = 1;
    grab.stiffness = 100;
    grab.damping = 1;
    ASSERT_EQ(pent_add_grab(host, &grab), 1);
    simulator::Grab<4> own;
    own.point.cell = 2;
    own.point.weights << 0.25, 0, 0, 0, 0.75;
    own.anchor[3] = 1;
    own.stiffness = 100;
    own.damping = 1;
    EXPECT_EQ(simulation.add_grab(own), 1U);
    const Eigen::Vector4d there(0.1, 0.9, 0, 0.5);
    ASSERT_EQ(pent_move_grab(host, 1, there.data()), 0);
    simulation.move_grab(1, there);
    const Positions<4> forces = Positions<4>::Random(4, simulation.mesh(0).vertex_count());
    ASSERT_EQ(pent_set_forces(host, 0, forces.data()), 0);
    simulation.set_forces(0, forces);
    ASSERT_EQ(pent_set_gravity(host, there.data()), 0);
    simulation.set_gravity(there);
    step();
    ASSERT_EQ(pent_remove_grab(host, 1), 0);
    simulation.remove_grab(1);
    ASSERT_EQ(pent_set_forces(host, 0, nullptr), 0);
    simulation.set_forces(0, 0 * forces);
    step();
    const Positions<4> positions = 1.01 * simulation.positions(1);
    const Positions<4> velocities = 2 * positions;
    ASSERT_EQ(pent_set_state(host, 1, positions.data(), velocities.data()), 0);
    simulation.set_state(1, positions, velocities);
    step();
    const pent_mesh mesh = closed_c_mesh(test::box<4>());
    ASSERT_EQ(pent_add_body(host,
                            "[[body]]\nname = \"new\"\nmesh = \"-\"\nvelocity = [1, 0, 0, 0]\n"
                            "place = { translate = [0, 5, 0, 0] }\n",
                            &mesh),
              0)
        << pent_last_error();
    simulator::Body body;
    body.name = "new";
    body.place.translate = Eigen::Vector4d(0, 5, 0, 0);
    body.material = simulation.scene().bodies[0].material;
    body.velocity = Eigen::Vector4d::UnitX();
    simulation.add_body(body, test::box<4>());
    EXPECT_EQ(pent_find_body(host, "new"), 2);
    step();
    ASSERT_EQ(pent_remove_body(host, 0), 0);
    simulation.remove_body(0);
    EXPECT_STREQ(pent_body_name(host, 0), "high");
    const char* ball = "[[obstacle]]\nball = { center = [0, 4, 0, 0], radius = 0.6 }\n";
    ASSERT_EQ(pent_add_obstacle(host, ball), 0) << pent_last_error();
    simulation.add_obstacle(
        {.shape = simulator::BallObstacle{.center = Eigen::Vector4d(0, 4, 0, 0), .radius = 0.6}});
    EXPECT_EQ(pent_obstacle_count(host), 2);
    step();
    ASSERT_EQ(pent_remove_obstacle(host, 0), 0);
    simulation.remove_obstacle(0);
    step();
}

TEST(Plugin, GoesOnToTheBitFromASavedState) {
    const Host one = test::open4(1);
    const Host two = test::open4(3);
    for (int i = 0; i < 4; ++i) {
        ASSERT_EQ(pent_step(one, nullptr), 0);
    }
    pent_state* state = pent_save(one);
    ASSERT_NE(state, nullptr);
    ASSERT_EQ(pent_restore(two, state), 0);
    EXPECT_EQ(pent_time(two), pent_time(one));
    for (int i = 0; i < 4; ++i) {
        ASSERT_EQ(pent_step(one, nullptr), 0);
        ASSERT_EQ(pent_step(two, nullptr), 0);
    }
    const std::int64_t numbers = 4 * pent_vertex_count(one, 0);
    EXPECT_TRUE(std::equal(pent_positions(one, 0), pent_positions(one, 0) + numbers,
                           pent_positions(two, 0)));
    const Host flat = test::open3();
    EXPECT_EQ(pent_restore(flat, state), -1);
    expect_error("another dimension");
    EXPECT_EQ(pent_free_state(state), 0);
    EXPECT_EQ(pent_restore(two, state), -1);
    expect_error("there is no such state");
}

// Time is counted in steps, and BDF2 looks back one.
TEST(Plugin, RefusesAStateOfAnotherTimeStep) {
    const Host one = test::open4();
    const std::array<pent_mesh, 2> meshes = {test::closed_c_mesh(test::box<4>()),
                                             test::closed_c_mesh(test::box<4>())};
    std::string scene = test::kScene4;
    scene.insert(scene.find("[[body]]"), "steps_per_frame = 7\n");
    const Host other(pent_open_text(scene.c_str(), meshes.data(), 2, 1));
    ASSERT_EQ(pent_step(one, nullptr), 0);
    pent_state* state = pent_save(one);
    const double before = *pent_positions(other, 1);
    EXPECT_EQ(pent_restore(other, state), -1);
    expect_error("this one has steps of 0.00");
    EXPECT_EQ(pent_time(other), 0);
    EXPECT_EQ(*pent_positions(other, 1), before);
    EXPECT_EQ(pent_restore(one, state), 0);
    EXPECT_EQ(pent_free_state(state), 0);
}

// A box that lies on the ground, in three dimensions, and one that falls.
TEST(Plugin, ShowsAllThereIsOfABody) {
    const Host host = test::open3();
    ASSERT_EQ(pent_step(host, nullptr), 0);
    const SimplexMesh<3> mesh = test::box<3>();
    EXPECT_EQ(pent_dimension(host), 3);
    EXPECT_EQ(pent_time_step(host), 1 / 30.0);
    EXPECT_EQ(pent_time(host), 1 / 30.0);
    EXPECT_STREQ(pent_body_name(host, 0), "low");
    EXPECT_EQ(pent_find_body(host, "high"), 1);
    EXPECT_EQ(pent_vertex_count(host, 0), mesh.vertex_count());
    EXPECT_EQ(pent_cell_count(host, 0), mesh.cell_count());
    EXPECT_EQ(pent_is_asleep(host, 0), 0);
    EXPECT_TRUE(
        std::equal(mesh.cells.data(), mesh.cells.data() + mesh.cells.size(), pent_cells(host, 1)));
    EXPECT_TRUE(std::equal(mesh.positions.data(), mesh.positions.data() + mesh.positions.size(),
                           pent_rest_positions(host, 0)));
    // After 1/30 s of free fall; the first body is pushed up.
    EXPECT_NEAR(pent_velocities(host, 1)[1], -0.3, 1e-4);  // the default tolerance of the solver
    EXPECT_GT(pent_velocities(host, 0)[1], -0.29);
    EXPECT_NEAR(pent_forces(host, 1)[1], -9 * pent_masses(host, 1)[0], 1);
    std::int64_t count = 0;
    const pent_contact* contacts = pent_contacts(host, &count);
    ASSERT_EQ(count, 4);  // the bottom of a box of one cell
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(contacts[i].first, 0);
        EXPECT_EQ(contacts[i].second, 0);
        EXPECT_EQ(contacts[i].is_obstacle, 1);
        EXPECT_LT(contacts[i].distance, 0.1);
        EXPECT_GT(contacts[i].force[1], 0);
        EXPECT_EQ(contacts[i].force[0], 0);
    }
    std::map<std::string, double> energies;
    const pent_energy* list = pent_energies(host, &count);
    for (int i = 0; i < count; ++i) {
        energies[list[i].name] = list[i].energy;
        EXPECT_EQ(list[i].is_stored, 1);
    }
    EXPECT_GT(energies.at("kinetic"), 0);
    EXPECT_GT(energies.at("obstacle"), 0);
    EXPECT_TRUE(energies.count("elastic") == 1 && energies.count("gravity") == 1);
    ASSERT_NE(pent_boundary(host, 0, &count), nullptr);
    EXPECT_EQ(count, 12);
    pent_surface surface = {};
    ASSERT_EQ(pent_slice(host, 0, nullptr, 0, &surface), 0) << pent_last_error();
    EXPECT_EQ(surface.vertices, 8);
    EXPECT_EQ(surface.triangle_count, 12);
}

// The cube w = 0.25 of a tesseract, its volume by the triangles; and what a pointer meets of it.
TEST(Plugin, SlicesAndPicks) {
    const Host host = test::open4();
    const std::array<double, 4> w = {0, 0, 0, 2};
    pent_surface slice = {};
    ASSERT_EQ(pent_slice(host, 0, w.data(), 0.5, &slice), 0) << pent_last_error();
    double volume = 0;
    for (std::int64_t t = 0; t < slice.triangle_count; ++t) {
        Eigen::Matrix3d corners;
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t vertex = slice.triangles[3 * t + i];
            ASSERT_LT(vertex, slice.vertices);
            corners.col(i) = Eigen::Map<const Eigen::Vector3d>(slice.positions + 3 * vertex);
        }
        volume += corners.determinant() / 6;
    }
    EXPECT_NEAR(volume, 1, 1e-12);
    EXPECT_EQ(slice.frame[15], 1);
    const std::array<double, 4> eye = {0.3, 0.4, -2, 7};
    const std::array<double, 4> sight = {0, 0, 2, 0};
    pent_hit hit = {};
    ASSERT_EQ(pent_pick(host, w.data(), 0.5, eye.data(), sight.data(), &hit), 1);
    const std::array<double, 4> place = {0.3, 0.4, 0, 0.25};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(hit.place[i], place[i], 1e-11);
    }
    EXPECT_NEAR(hit.distance, 2, 1e-11);
    EXPECT_EQ(hit.point.body, 0);
    EXPECT_EQ(pent_pick(host, nullptr, 0, eye.data(), sight.data(), &hit), 0);  // w = 7
    EXPECT_STREQ(pent_last_error(), "");
}

// Muscles along the fibers of a mesh: as in the library; none without fibers.
TEST(Plugin, TakesTheFibersOfAMesh) {
    const char* scene =
        "[[body]]\nname = \"a\"\nmesh = \"-\"\n[[activation]]\nbody = \"a\"\n"
        "select = \"everything\"\nstretch = 1.5\nfibers = \"mesh\"\n";
    pent_mesh mesh = closed_c_mesh(test::box<4>());
    EXPECT_EQ(pent_open_text(scene, &mesh, 1, 1), nullptr);
    expect_error("the mesh has none");
    const Positions<4> fibers = Eigen::Vector4d::UnitZ().replicate(1, mesh.cell_count);
    mesh.fibers = fibers.data();
    const Host host(pent_open_text(scene, &mesh, 1, 1));
    ASSERT_EQ(pent_step(host, nullptr), 0) << pent_last_error();
    SimplexMesh<4> same = test::box<4>();
    same.fibers = fibers;
    Simulation<4> simulation(runs::parse_scene(scene, "scene", ""), {same});
    ASSERT_TRUE(simulation.step().is_accepted);
    EXPECT_GT((simulation.positions(0) - same.positions).norm(), 0.01);
    expect_same(host, simulation);
}

// Quadratic cells by the parents of their children, in an order that says nothing without them: as
// arrays, and from a file that the plugin wrote of them.
TEST(Plugin, TakesStepsOfQuadraticElementsAsTheLibraryDoes) {
    const pent::test::TempFolder folder;
    SimplexMesh<4> mesh = pent::test::quadratic_kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 1});
    mesh.positions.row(1) *= 1.1;
    const std::string scene =
        "[scene]\ngravity = [0, -9, 0, 0]\n"
        "[solver]\nelements = \"quadratic\"\nintegrator = \"bdf2\"\n"
        "[[body]]\nname = \"a\"\nmesh = \"a.pent\"\n"
        "[[constraint]]\nbody = \"a\"\nselect = { half_space = { normal = [1, 0, 0, 0], "
        "offset = 1e-6 } }\n";
    pent_mesh arrays = closed_c_mesh(mesh);
    EXPECT_EQ(pent_open_text(scene.c_str(), &arrays, 1, 1), nullptr);
    expect_error("pent-mesh --quadratic");
    arrays.parents = mesh.parents.data();
    const Host host(pent_open_text(scene.c_str(), &arrays, 1, 1));
    const test::StoredMesh stored(pent_store_mesh(4, &arrays, nullptr));
    ASSERT_EQ(pent_write_mesh(stored, (folder / "a.pent").c_str(), "", 0), 0) << pent_last_error();
    write_text(folder / "scene.toml", scene);
    const Host from_file(pent_open_file((folder / "scene.toml").c_str(), 1));
    Simulation<4> simulation(runs::parse_scene(scene, "scene", ""), {mesh});
    for (int step = 0; step < 3; ++step) {
        ASSERT_EQ(pent_step(host, nullptr), 0) << pent_last_error();
        ASSERT_EQ(pent_step(from_file, nullptr), 0) << pent_last_error();
        ASSERT_TRUE(simulation.step().is_accepted);
        expect_same(host, simulation);
        expect_same(from_file, simulation);
    }
    EXPECT_GT((simulation.positions(0) - mesh.positions).norm(), 0.01);
}

TEST(Plugin, OpensASceneFromMemoryOrSaysWhereItIsWrong) {
    const pent_mesh mesh = closed_c_mesh(test::box<4>());
    EXPECT_EQ(pent_open_text("[scene]\ngravitty = 3\n", &mesh, 1, 1), nullptr);
    expect_error("scene:2:1: ");
    EXPECT_EQ(pent_open_text("[[body]]\nname = \"a\"\nmesh = \"-\"\n", &mesh, 2, 1), nullptr);
    expect_error("the scene has 1 body; got 2 meshes");
    const char* selects_nothing =
        "[[body]]\nname = \"a\"\nmesh = \"-\"\n[[constraint]]\n"
        "body = \"a\"\nselect = { layers = { first = 7 } }\n";
    EXPECT_EQ(pent_open_scene(selects_nothing, "my.toml", "/x", &mesh, 1, 1), nullptr);
    expect_error("my.toml:6:");
    EXPECT_EQ(pent_open_scene(selects_nothing, nullptr, "/x", &mesh, 1, 1), nullptr);
    expect_error("name is NULL");
    EXPECT_EQ(pent_open_scene(selects_nothing, "my.toml", nullptr, &mesh, 1, 1), nullptr);
    expect_error("folder is NULL");
    EXPECT_EQ(pent_open_file("/no/such/scene.toml", 1), nullptr);
    expect_error("/no/such/scene.toml");
}

}  // namespace
}  // namespace pent
