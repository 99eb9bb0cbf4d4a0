#include "plugin_client.h"
#include "support/kuhn_box.h"
#include "support/temp_folder.h"

#include <pent/output_file.h>
#include <pent/pent_file.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <dlfcn.h>
#include <pent_plugin.h>

namespace pent {
namespace {

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

template <typename Function>
Function* find(void* library, const char* name) {
    void* symbol = ::dlsym(library, name);
    EXPECT_NE(symbol, nullptr) << name;
    return reinterpret_cast<Function*>(symbol);
}

// A box that lies on the ground, in three dimensions, and one that falls.
TEST(Plugin, ShowsAllThereIsOfABody) {
    const pent::test::TempFolder folder;
    const SimplexMesh<3> mesh = pent::test::kuhn_box<3>({1, 1, 1}, {1, 1, 1});
    write_mesh(folder / "box.pent", mesh);
    write_text(folder / "scene.toml",
               "[scene]\ndimension = 3\ngravity = [0, -9, 0]\n"
               "[[body]]\nname = \"low\"\nmesh = \"box.pent\"\n"
               "[[body]]\nname = \"high\"\nmesh = \"box.pent\"\n"
               "place = { translate = [0, 5, 0] }\n"
               "[[obstacle]]\nhalf_space = { normal = [0, 1, 0] }\ndistance = 0.1\n"
               "[output]\ncontact_forces = true\n");
    void* library = ::dlopen(PENT_PLUGIN_PATH, RTLD_NOW | RTLD_LOCAL);
    ASSERT_NE(library, nullptr);
    pent_simulation* simulation = find<decltype(pent_open)>(library, "pent_open")(
        (folder / "scene.toml").string().c_str(), 1);
    ASSERT_NE(simulation, nullptr);
    ASSERT_EQ(find<decltype(pent_step)>(library, "pent_step")(simulation, nullptr), 0);
    EXPECT_EQ(find<decltype(pent_dimension)>(library, "pent_dimension")(simulation), 3);
    auto* name = find<decltype(pent_body_name)>(library, "pent_body_name");
    EXPECT_STREQ(name(simulation, 0), "low");
    EXPECT_STREQ(name(simulation, 1), "high");
    EXPECT_EQ(name(simulation, 2), nullptr);
    const std::uint32_t* cells = find<decltype(pent_cells)>(library, "pent_cells")(simulation, 1);
    EXPECT_TRUE(std::equal(mesh.cells.data(), mesh.cells.data() + mesh.cells.size(), cells));
    // After 1/30 s of free fall; the first body is pushed up.
    auto* velocities = find<decltype(pent_velocities)>(library, "pent_velocities");
    EXPECT_NEAR(velocities(simulation, 1)[1], -0.3, 1e-4);  // the default tolerance of the solver
    EXPECT_GT(velocities(simulation, 0)[1], -0.29);
    pent_contact_report contacts = {};
    EXPECT_EQ(find<decltype(pent_contacts)>(library, "pent_contacts")(simulation, &contacts), 0);
    EXPECT_EQ(contacts.obstacle, 4);  // the bottom of a box of one cell
    EXPECT_EQ(contacts.point_facet + contacts.mixed, 0);
    EXPECT_NE(find<decltype(pent_forces)>(library, "pent_forces")(simulation, 0), nullptr);
    find<decltype(pent_close)>(library, "pent_close")(simulation);
    ::dlclose(library);
}

}  // namespace
}  // namespace pent
