#include "plugin_client.h"
#include "support/kuhn_box.h"
#include "support/temp_folder.h"

#include <pent/output_file.h>
#include <pent/pent_file.h>

#include <gtest/gtest.h>

#include <pent_plugin.h>

namespace pent::simulator {
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

}  // namespace
}  // namespace pent::simulator
