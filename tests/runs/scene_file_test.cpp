#include "scene_text.h"
#include "support/kuhn_box.h"
#include "support/temp_folder.h"

#include <pent/error.h>
#include <pent/pent_file.h>
#include <pent/runs/scene_file.h>

#include <gtest/gtest.h>

namespace pent::runs {
namespace {

using namespace simulator;
using test::error_of;
using test::parse;
using test::with;

constexpr std::string_view kFull = R"([scene]
gravity = [0, -9.8, 0, 0]
frames = 300
frames_per_second = 60
steps_per_frame = 2

[[body]]
name = "bunny"
mesh = "meshes/bunny.pent"
place = { scale = 2, translate = [0, 1, 0, 0], rotate = [{ plane = "xw", degrees = 30 }] }
material = { model = "stable-neo-hookean", young = 1e5, poisson = 0.28, density = 1100 }

[[body]]
name = "core"
mesh = "core.pent"
material = { model = "arap", mu = 2e4, lambda = 1e4 }
velocity = [0, 2, 0, 0]
spin = [{ plane = "wz", degrees_per_s = -40 }]

[[body]]
name = "sole"
mesh = "sole.pent"
material = { model = "mooney-rivlin", second_invariant = 0.25 }

[[constraint]]
body = "bunny"
select = [{ ball = { center = [0, 0, 0, 0.2], radius = 0.3 } },
          { box = { low = [0, 0, 0, 0], high = [1, 1, 1, 1] } },
          { half_space = { normal = [0, 2, 0, 0], offset = 0.1 } },
          { layers = { first = 0, last = 2 } },
          { region = 3 }]
motion = [{ rotate = [{ plane = "yz", degrees_per_s = 90 },
                      { plane = "wx", degrees_per_s = 60 }], translate = [
            0.1, 0, 0, 0], about = [0, 1, 0, 0], from = 0.5, to = 2 },
          { translate = [0, -1, 0, 0], from = 2 }]

[[constraint]]
body = "core"
select = "everything"
motion = "fixed"

[[load]]
body = "bunny"
select = "everything"
force = [0, 2, 0, 1]
pressure = -30
keyframes = [{ time = 0, factor = 0 }, { time = 1.5, factor = 1 }]

[[obstacle]]
half_space = { normal = [0, 1, 0, 0], offset = -1 }
distance = 0.01
stiffness = 500

[[obstacle]]
ball = { center = [0, -3, 0, 0], radius = 2 }

[[obstacle]]
cavity = { center = [0, 0, 0, 0], radius = 20 }

[[obstacle]]
bowl = { center = [0, 0, 1, 0], radius = 6, up = [0, 0, 2, 0] }
distance = 0.1

[contact]
model = "penalty"
distance = 0.03
stiffness = 2500
self = true
filter = "absolute"

[damping]
mass = 0.1
stiffness = 0.001

[sleep]
speed = 0.002

[solver]
preset = "accurate"
elements = "smoothed"
filter = "absolute"
max_halvings = 3

[output]
vertex = ["energy_density", "contact_force"]
contact_pairs = true
)";

TEST(ParseScene, ReadsEveryKey) {
    const Scene scene = parse(kFull);
    EXPECT_EQ(scene.dimension, 4);
    EXPECT_EQ(scene.gravity, Eigen::Vector4d(0, -9.8, 0, 0));
    EXPECT_DOUBLE_EQ(scene.dt(), 1.0 / 120);
    ASSERT_EQ(scene.bodies.size(), 3U);
    EXPECT_EQ(scene.bodies[0].mesh, "/data/meshes/bunny.pent");
    EXPECT_EQ(scene.bodies[0].place.scale, 2);
    EXPECT_EQ(plane_name(scene.bodies[0].place.rotate[0].plane), "xw");
    EXPECT_EQ(scene.bodies[0].material.density, 1100);
    EXPECT_EQ(scene.bodies[1].material.model, Model::Arap);
    EXPECT_EQ(scene.bodies[1].material.lame.lambda, 1e4);
    EXPECT_EQ(scene.bodies[2].material.second_invariant, 0.25);
    ASSERT_EQ(scene.constraints.size(), 2U);
    EXPECT_EQ(scene.constraints[0].select.size(), 5U);
    const auto& half_space = std::get<HalfSpaceSelection>(scene.constraints[0].select[2]);
    EXPECT_EQ(half_space.normal, Eigen::Vector4d(0, 1, 0, 0));
    EXPECT_EQ(scene.constraints[0].motion.at(0).rotate[1].plane.from, 3);
    EXPECT_EQ(scene.constraints[0].motion.at(0).to, 2);
    EXPECT_EQ(scene.constraints[0].motion.at(1).translate, Eigen::Vector4d(0, -1, 0, 0));
    EXPECT_TRUE(scene.constraints[1].motion.empty());
    EXPECT_EQ(scene.bodies[1].velocity, Eigen::Vector4d(0, 2, 0, 0));
    EXPECT_EQ(scene.bodies[1].spin.at(0).degrees_per_s, -40);
    ASSERT_EQ(scene.loads.size(), 1U);
    EXPECT_EQ(scene.loads[0].force, Eigen::Vector4d(0, 2, 0, 1));
    EXPECT_EQ(scene.loads[0].pressure, -30);
    EXPECT_EQ(scene.loads[0].keyframes.at(1).time, 1.5);
    ASSERT_EQ(scene.obstacles.size(), 4U);
    EXPECT_EQ(scene.obstacles[0].stiffness, 500);
    EXPECT_EQ(std::get<HalfSpaceObstacle>(scene.obstacles[0].shape).offset, -1);
    EXPECT_EQ(std::get<BallObstacle>(scene.obstacles[1].shape).radius, 2);
    EXPECT_EQ(std::get<CavityObstacle>(scene.obstacles[2].shape).radius, 20);
    EXPECT_EQ(std::get<BowlObstacle>(scene.obstacles[3].shape).up, Eigen::Vector4d(0, 0, 1, 0));
    EXPECT_EQ(scene.obstacles[3].distance, 0.1);
    ASSERT_TRUE(scene.contact.has_value());
    EXPECT_EQ(scene.contact->distance, 0.03);
    EXPECT_EQ(scene.contact->stiffness, 2500);
    EXPECT_TRUE(scene.contact->self);
    EXPECT_EQ(scene.contact->filter, Filter::Absolute);
    EXPECT_EQ(scene.output.vertex, (std::vector{simulator::VertexQuantity::EnergyDensity,
                                                simulator::VertexQuantity::ContactForce}));
    EXPECT_TRUE(scene.output.contact_pairs);
    EXPECT_EQ(scene.damping->stiffness, 0.001);
    ASSERT_TRUE(scene.sleep.has_value());
    EXPECT_EQ(scene.sleep->speed, 0.002);
    EXPECT_EQ(scene.sleep->time, 0.5);
    EXPECT_EQ(scene.solver.integrator, Integrator::Bdf2);
    EXPECT_EQ(scene.solver.elements, ElementKind::Smoothed);
    EXPECT_EQ(scene.solver.filter, Filter::Absolute);
    EXPECT_EQ(scene.solver.max_halvings, 3);
}

TEST(ParseScene, FillsInDefaults) {
    const Scene scene = parse(with(""));
    EXPECT_EQ(scene.gravity, Eigen::Vector4d::Zero());
    EXPECT_EQ(scene.frames, 100);
    EXPECT_FALSE(scene.damping.has_value());
    EXPECT_FALSE(scene.contact.has_value());
    EXPECT_TRUE(scene.output.vertex.empty());
    EXPECT_EQ(scene.bodies[0].place.scale, 1);
    EXPECT_NEAR(young_from_lame(4, scene.bodies[0].material.lame).poisson, 0.28, 1e-14);
}

TEST(ParseScene, TakesTheKeyOfVersion010ForForcesOfContact) {
    EXPECT_EQ(parse(with("[output]\ncontact_forces = true\n")).output.vertex,
              std::vector{simulator::VertexQuantity::ContactForce});
}

TEST(ParseScene, FillsInDefaultsOfContact) {
    const Scene scene =
        parse(with("[contact]\n[[obstacle]]\nbowl = { center = [0,0,0,0], radius = 6 }\n"));
    EXPECT_EQ(scene.contact->model, ContactModel::Penalty);
    EXPECT_EQ(scene.contact->distance, 0.02);
    EXPECT_EQ(scene.contact->stiffness, 1000);
    EXPECT_FALSE(scene.contact->self);
    EXPECT_EQ(scene.contact->filter, Filter::Clamp);
    EXPECT_EQ(std::get<BowlObstacle>(scene.obstacles[0].shape).up, Eigen::Vector4d(0, 1, 0, 0));
}

TEST(ParseScene, TakesThreeDimensions) {
    const Scene scene = parse(
        "[scene]\ndimension = 3\ngravity = [0, -9.8, 0]\n"
        "[[body]]\nname = 'a'\nmesh = 'a.pent'\n"
        "material = { poisson = 0.45 }\n");
    EXPECT_EQ(scene.gravity.size(), 3);
}

// What is written is read back as the same scene, to the last bit of every number.
TEST(SceneText, IsReadBackAsTheSameScene) {
    for (const std::string& text : {std::string(kFull), with("")}) {
        const Scene scene = parse(text);
        const std::string written = scene_text(scene);
        EXPECT_EQ(scene_text(parse_scene(written, "again", "")), written);
    }
}

TEST(SceneText, KeepsEveryCharacterOfARecipe) {
    const Scene scene = parse(with("recipe = \"a\\u0001 \\\"b\\\" \\\\ \\u007f\"\n"));
    EXPECT_EQ(scene.bodies[0].recipe, "a\x01 \"b\" \\ \x7f");
    EXPECT_EQ(parse(scene_text(scene)).bodies[0].recipe, scene.bodies[0].recipe);
}

TEST(ParseScene, TakesACoarserToleranceForTheFastPreset) {
    const auto tolerance = [](const std::string& preset) {
        return parse(with("[solver]\npreset = \"" + preset + "\"\n")).solver.tolerance;
    };
    EXPECT_GT(tolerance("fast"), tolerance("balanced"));
}

TEST(ReadScene, TakesQuadraticElementsForTheAccuratePresetWhereEveryMeshHasThem) {
    const pent::test::TempFolder folder;
    const auto elements = [&](const std::string& solver) {
        return parse_scene(
                   "[[body]]\nname = \"a\"\nmesh = \"a.pent\"\n"
                   "[[body]]\nname = \"b\"\nmesh = \"b.pent\"\n[solver]\n"
                       + solver,
                   "s.toml", folder.path())
            .solver.elements;
    };
    const std::string accurate = "preset = \"accurate\"\n";
    const auto quadratic = pent::test::quadratic_kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 1});
    SimplexMesh<4> plain = quadratic;
    plain.parents.clear();
    write_mesh(folder / "a.pent", quadratic);
    EXPECT_EQ(elements(accurate), ElementKind::Linear);  // b is not there
    write_mesh(folder / "b.pent", plain);
    EXPECT_EQ(elements(accurate), ElementKind::Linear);
    write_mesh(folder / "b.pent", quadratic);
    EXPECT_EQ(elements(accurate), ElementKind::Quadratic);
    EXPECT_EQ(elements(accurate + "elements = \"linear\"\n"), ElementKind::Linear);
    EXPECT_EQ(elements("preset = \"balanced\"\n"), ElementKind::Linear);
    EXPECT_EQ(elements(""), ElementKind::Linear);
    // Written out, they stay what they are.
    const Scene scene =
        parse_scene("[[body]]\nname = \"a\"\nmesh = \"a.pent\"\n[solver]\n" + accurate, "s.toml",
                    folder.path());
    EXPECT_EQ(parse_scene(scene_text(scene), "again", "").solver.elements, ElementKind::Quadratic);
}

TEST(ParseScene, KnowsWhereMeshesAndSelectionsStand) {
    const Scene scene = parse(with("[[constraint]]\nbody = \"a\"\nselect = \"everything\"\n"));
    EXPECT_EQ(scene.bodies[0].source, "scene.toml:3:8");
    EXPECT_EQ(scene.constraints[0].source, "scene.toml:7:10");
}

// What young and poisson at the borders of their ranges make of mu and lambda is read back.
TEST(SceneText, OfExtremeMaterialsIsReadBack) {
    for (const char* young : {"1e-30", "1e30"}) {
        for (const char* poisson : {"1e-30", "0.333333333333", "-0.999999999999"}) {
            const Scene scene = parse(with(std::string("material = { young = ") + young
                                           + ", poisson = " + poisson + " }\n"));
            EXPECT_NO_THROW(static_cast<void>(parse(scene_text(scene)))) << young << poisson;
        }
    }
}

TEST(ReadScene, SaysThatAFolderIsNoScene) {
    try {
        static_cast<void>(read_scene("/"));
        FAIL();
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(),
                     "/: cannot be read: Is a directory; expected a scene file (TOML)");
    }
}

TEST(ReadScene, NamesAFileThatIsNotThere) {
    try {
        static_cast<void>(read_scene("/no/such/scene.toml"));
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("/no/such/scene.toml"), std::string::npos);
    }
}

}  // namespace
}  // namespace pent::runs
