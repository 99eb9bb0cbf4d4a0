#include <pent/error.h>
#include <pent/runs/scene_file.h>

#include <gtest/gtest.h>

namespace pent::runs {
namespace {

using namespace simulator;

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
motion = [{ rotate = [{ plane = "yz", degrees_per_s = 90 }, { plane = "wx", degrees_per_s = 60 }], translate = [0.1, 0, 0, 0], about = [0, 1, 0, 0], from = 0.5, to = 2 },
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

Scene parse(std::string_view text) {
    return parse_scene(text, "scene.toml", "/data");
}

std::string error_of(std::string_view text) {
    try {
        static_cast<void>(parse(text));
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

// A whole scene around one line or block that is under test; the block starts in line 5.
std::string with(const std::string& block) {
    return "[[body]]\nname = \"a\"\nmesh = \"a.pent\"\n\n" + block;
}

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

TEST(ParseSceneErrors, NameTheNearestKeyAtItsPlace) {
    EXPECT_EQ(error_of("[scene]\ngraviti = [0, 0, 0, 0]\n[[body]]\nname='a'\nmesh='a.pent'\n"),
              "scene.toml:2:1: unknown key \"graviti\" in \"scene\"; did you mean \"gravity\"?");
    EXPECT_EQ(error_of(with("[solvr]\n")),
              "scene.toml:5:2: unknown key \"solvr\" in the scene; did you mean \"solver\"?");
}

struct Bad {
    std::string text;
    std::string expected;  // part of the message
};

class BadScenes : public testing::TestWithParam<Bad> {};

TEST_P(BadScenes, AreRefusedWithPlaceAndReason) {
    const std::string message = error_of(GetParam().text);
    EXPECT_EQ(message.rfind("scene.toml:", 0), 0U) << message;
    EXPECT_NE(message.find(GetParam().expected), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    All,
    BadScenes,
    testing::Values(
        Bad{"", "no [[body]]"},
        Bad{"[scene\n", "scene.toml:1:"},
        Bad{"[scene]\nframes = 0\n", "expected a whole number from 1"},
        Bad{"[scene]\nframes = 2.5\n", "\"frames\" is 2.5"},
        Bad{"[scene]\nframes = \"ten\"\n", "the text \"ten\""},
        Bad{"[scene]\nframes_per_second = 0\n", "a number above 0"},
        Bad{"[scene]\nframes_per_second = nan\n", "a number above 0"},
        Bad{with("[[body]]\nname = \"b\"\nmesh = \"b.pent\"\nmaterial = { young = 2.0,"
                 " second_invariant = 0.5 }\n"),
            "scene.toml:8:46: \"second_invariant\" goes with model = \"mooney-rivlin\" alone"},
        Bad{with("[[body]]\nname = \"b\"\nmesh = \"b.pent\"\nmaterial = { model ="
                 " \"mooney-rivlin\", second_invariant = 1.5 }\n"),
            "\"second_invariant\" is 1.5; expected a number of at least 0 and at most 1"},
        Bad{with("[[body]]\nname = \"b\"\nmesh = \"b.pent\"\nmaterial = { model ="
                 " \"mooney-rivlin\", mu = 4, lambda = -1, second_invariant = 0.8 }\n"),
            "\"second_invariant\" is 0.8; expected a number of at least 0 and at most 0.75"},
        Bad{with("[[body]]\nname = \"b\"\nmesh = \"b.pent\"\nmaterial = { model ="
                 " \"mooney-rivlin\" }\n"),
            "needs \"second_invariant\""},
        Bad{"[scene]\ngravity = 3\n", "\"gravity\" is 3; expected 4 numbers"},
        Bad{"[scene]\ngravity = [0, -9.8, 0]\n", "3 entries; expected 4 numbers"},
        Bad{"[scene]\ngravity = [0, -9.8, 0, \"x\"]\n", "the entry the text \"x\""},
        Bad{"[scene]\ngravity = [0, -9.8, 0, inf]\n", "4 numbers"},
        Bad{"[scene]\ndimension = 5\n", "from 3 to 4"},
        Bad{"scene = 3\n", "expected a table"},
        Bad{"[[body]]\nname = \"a\"\n", "needs \"mesh\""},
        Bad{"[[body]]\nname = [1]\n", "\"name\" is an array; expected text in quotes"},
        Bad{"[[body]]\nname = {}\n", "\"name\" is a table; expected text in quotes"},
        Bad{"[[body]]\nname = true\n", "\"name\" is true; expected text in quotes"},
        Bad{"[[body]]\nname = 2026-01-01\n", "\"name\" is a date or time; expected text"},
        Bad{"body = 3\n", "\"body\" is 3; expected a list of tables"},
        Bad{"body = [3]\n", "\"body\" has the entry 3; expected a table"},
        Bad{with("material = { young = \"soft\" }\n"),
            "the text \"soft\"; expected a number above 0"},
        Bad{"[[body]]\nname = 3\nmesh = \"a.pent\"\n", "\"name\" is 3; expected text in quotes"},
        Bad{"[[body]]\nname = \"a\"\nmash = \"a.pent\"\n", "found the unknown key \"mash\""},
        Bad{"[[body]]\nname = \"a b\"\nmesh = \"a.pent\"\n", "letters, digits"},
        Bad{"[[body]]\nname = \"../a\"\nmesh = \"a.pent\"\n", "letters, digits"},
        Bad{with("[[body]]\nname = \"a\"\nmesh = \"b.pent\"\n"), "two bodies"},
        Bad{with("material = { poisson = 0.4 }\n"), "below 1/3"},
        Bad{with("material = { young = -1 }\n"), "above 0"},
        Bad{with("material = { model = \"neo\" }\n"), "expected one of \"stable-neo-hookean\""},
        Bad{with("material = { mu = 1, lambda = 1, young = 3 }\n"), "one pair or the other"},
        Bad{with("material = { mu = 1, lambda = -0.6 }\n"), "above -0.5"},
        Bad{with("place = { rotate = [{ plane = \"xx\", degrees = 3 }] }\n"), "different axes"},
        Bad{with("place = { rotate = [{ plane = \"xv\", degrees = 3 }] }\n"), "xyzw"},
        Bad{with("place = { scale = 0 }\n"), "above 0"},
        Bad{with("velocity = [1, 2]\n"), "4 numbers"},
        Bad{with("spin = { plane = \"xw\", degrees = 3 }\n"), "needs \"degrees_per_s\""},
        Bad{with("[[constraint]]\nbody = \"b\"\nselect = \"everything\"\n"), "no body is called"},
        Bad{with("[[constraint]]\nbody = \"a\"\n"), "needs \"select\""},
        Bad{with("[[constraint]]\nbody = \"a\"\nselect = \"all\"\n"), "\"everything\""},
        Bad{with("[[constraint]]\nbody = \"a\"\nselect = { bal = 3 }\n"), "\"ball\"?"},
        Bad{with("[[constraint]]\nbody = \"a\"\nselect = {}\n"), "has 0 of ball"},
        Bad{with("[[constraint]]\nbody = \"a\"\nselect = { region = 1, layers = { first = 1 } }\n"),
            "has 2 of ball"},
        Bad{with("[[constraint]]\nbody = \"a\"\n"
                 "select = { ball = { center = [0,0,0,0], radius = 0 } }\n"),
            "above 0"},
        Bad{with("[[constraint]]\nbody = \"a\"\n"
                 "select = { layers = { last = 1 } }\n"),
            "needs \"first\""},
        Bad{with("[[constraint]]\nbody = \"a\"\n"
                 "select = { box = { low = [0, 0, 2, 0], high = [1, 1, 1, 1] } }\n"),
            "\"low\" is above \"high\""},
        Bad{with("[[constraint]]\nbody = \"a\"\n"
                 "select = { layers = { first = 2, last = 1 } }\n"),
            "\"last\" is before \"first\""},
        Bad{with("[[constraint]]\nbody = \"a\"\n"
                 "select = { half_space = { normal = [0,0,0,0] } }\n"),
            "expected a direction"},
        Bad{with("[[constraint]]\nbody = \"a\"\nselect = \"everything\"\n"
                 "motion = { from = 2, to = 1 }\n"),
            "above 2"},
        Bad{with("[[constraint]]\nbody = \"a\"\nselect = \"everything\"\nfrom = 2\nto = 2\n"),
            "scene.toml:9:6: \"to\" is 2; expected a number above 2"},
        Bad{with("[[attachment]]\nbody = \"aa\"\nselect = \"everything\"\n"),
            "scene.toml:6:8: no body is called \"aa\"; did you mean \"a\"?"},
        Bad{with("[[attachment]]\nbody = \"a\"\nselect = \"everything\"\ntarget = \"b\"\n"),
            "scene.toml:8:10: no body is called \"b\""},
        Bad{with("[[attachment]]\nbody = \"a\"\nselect = \"everything\"\ntarget = \"a\"\n"),
            "scene.toml:8:10: \"target\" is the body itself"},
        Bad{with("[[attachment]]\nbody = \"a\"\n"), "needs \"select\""},
        Bad{with("[[attachment]]\nbody = \"a\"\nselect = \"everything\"\nstiffness = 0\n"),
            "above 0"},
        Bad{with("[[attachment]]\nbody = \"a\"\nselect = \"everything\"\nfrom = 3\nto = 1\n"),
            "above 3"},
        Bad{with("[[attachment]]\nbody = \"a\"\nselect = \"everything\"\noffset = \"none\"\n"),
            "expected one of \"keep\", \"zero\""},
        Bad{with("[[body]]\nname = \"b\"\nmesh = \"b.pent\"\n[[attachment]]\nbody = \"a\"\n"
                 "target = \"b\"\nselect = \"everything\"\npoint = [0, 0, 0, 0]\n"),
            "scene.toml:12:9: \"point\" is of points in space and does not go together with"},
        Bad{with(
                "[[body]]\nname = \"b\"\nmesh = \"b.pent\"\n[[attachment]]\nbody = \"a\"\n"
                "target = \"b\"\nselect = \"everything\"\nmotion = { translate = [1, 0, 0, 0] }\n"),
            "scene.toml:12:10: \"motion\" is of points in space"},
        Bad{with("[contact]\nignore = [{ first = \"a\", second = \"ab\" }]\n"),
            "scene.toml:6:10: contact: no body is called \"ab\"; did you mean \"a\"?"},
        Bad{with("[contact]\nonly = [{ first = \"x\", second = \"a\" }]\n"),
            "scene.toml:6:8: contact: no body is called \"x\""},
        Bad{with("[contact]\nonly = [{ first = \"a\" }]\n"), "needs \"second\""},
        Bad{with("[[obstacle]]\nbox = { center = [0,0,0,0], sides = [1,1,1,1] }\n"
                 "motion = { rotate = { plane = \"xw\", degrees_per_s = 9 } }\n"),
            "scene.toml:7:10: a box lies along the axes and cannot turn"},
        Bad{with("friction = -1\n"), "at least 0"},
        Bad{with("[[obstacle]]\ndistance = 1\n"), "has 0 of half_space, ball, cavity, bowl"},
        Bad{with("[[obstacle]]\ndistance = 0\n"), "above 0"},
        Bad{with("[[obstacle]]\nbowl = {}\n"), "needs \"center\""},
        Bad{with("[[obstacle]]\nbowll = {}\n"), "did you mean \"bowl\"?"},
        Bad{with("[[obstacle]]\nball = { center = [0,0,0,0], radius = 1 }\n"
                 "cavity = { center = [0,0,0,0], radius = 1 }\n"),
            "has 2 of half_space"},
        Bad{with("[[obstacle]]\nball = { center = [0,0,0,0], radius = 0 }\n"), "above 0"},
        Bad{with("[[obstacle]]\nhalf_space = { normal = [0,0,0,0] }\n"), "expected a direction"},
        Bad{with("[contact]\nmodel = \"glue\"\n"), "expected one of \"penalty\""},
        Bad{with("[contact]\ndistance = 0\n"), "above 0"},
        Bad{with("[contact]\nstiffness = -1\n"), "above 0"},
        Bad{with("[contact]\nself = 1\n"), "\"self\" is 1; expected true or false"},
        Bad{with("[output]\ncontact_force = true\n"), "did you mean \"contact_forces\"?"},
        Bad{with("[output]\nvertex = true\n"),
            "scene.toml:6:10: \"vertex\" is true; expected a list"},
        Bad{with("[output]\nvertex = [1]\n"), "has the entry 1; expected a name"},
        Bad{with("[output]\nvertex = [\"reactions\"]\n"),
            "expected one of \"contact_force\", \"reaction\", \"energy_density\"; did you mean"},
        Bad{with("[output]\nvertex = [\"reaction\", \"reaction\"]\n"), "\"reaction\" twice"},
        Bad{with("[[load]]\nbody = \"a\"\nselect = \"everything\"\n"),
            "a load needs a \"force\" or a \"pressure\""},
        Bad{with("[[load]]\nbody = \"b\"\nselect = \"everything\"\npressure = 1\n"),
            "scene.toml:6:8: no body is called \"b\"; did you mean \"a\"?"},
        Bad{with("[[load]]\nbody = \"a\"\nselect = \"everything\"\npressure = 1\n"
                 "keyframes = [{ time = 1, factor = 0 }, { time = 1, factor = 2 }]\n"),
            "scene.toml:9:13: the times of \"keyframes\" must increase"},
        Bad{with("[[load]]\nbody = \"a\"\nselect = \"everything\"\npressure = 1\n"
                 "keyframes = [{ time = -1, factor = 0 }]\n"),
            "\"time\" is -1; expected a number of at least 0"},
        Bad{with("[solver]\nintegrator = \"rk4\"\n"), "\"linear_euler\""},
        Bad{with("[solver]\nelements = \"cubic\"\n"), "\"smoothed\""},
        Bad{with("[solver]\ntolerance = 1\n"), "below 1"},
        Bad{with("[damping]\nmass = -1\n"), "at least 0"},
        Bad{with("[[obstacle]]\nplane = { normal = [0,1,0,0] }\n"),
            "scene.toml:6:1: unknown key \"plane\" in \"obstacle\"; expected one of half_space, "
            "ball,"},
        Bad{"[[body]]\nmesh = \"a.pent\"\nmaterial = {}\n", "1:1: \"body\" needs \"name\" (text)"},
        Bad{"[[body]]\nname = \"" + std::string(101, 'a') + "\"\nmesh = \"a.pent\"\n",
            "at most 100 of them"},
        Bad{with("[contact]\nmodel = \"barrier\"\n"), "scene.toml:6:9: contact: the barrier model"},
        Bad{with("[sleep]\n[solver]\nintegrator = \"quasistatic\"\n[[constraint]]\nbody = \"a\"\n"
                 "select = \"everything\"\n"),
            "scene.toml:5:1: sleep: the quasistatic"},
        Bad{with("[solver]\nintegrator = \"quasistatic\"\n"),
            "scene.toml:2:8: body \"a\" has no constraint that lasts"},
        Bad{with("place = { scale = 1e-200 }\n"), "expected a size from 1e-30 to 1e+30"},
        Bad{with("place = { translate = [1e200, 0, 0, 0] }\n"),
            "expected 0 or a size from 1e-30 to 1e+30"},
        Bad{with("material = { density = 1e-300 }\n"), "expected a size from 1e-30 to 1e+30"},
        Bad{with("spin = { plane = \"xw\", degrees_per_s = 1e300 }\n"),
            "at least -1e+09 and at most 1e+09"},
        Bad{with("place = { rotate = [{ plane = \"xy\", degrees = 1e300 }] }\n"), "at most 1e+09"},
        Bad{with("[sleep]\ntime = 1e20\n"), "to 1e+06"},
        Bad{with("[sleep]\ntime = 0\n"), "above 0"},
        Bad{with("[sleep]\nspeeed = 1\n"), "did you mean \"speed\"?"}));

// A key that is missing is not blamed on one that is right.
TEST(ParseSceneErrors, NameNoOtherKeyThanOneThatLooksLikeTheMissingOne) {
    EXPECT_EQ(error_of("[[body]]\nmesh = \"a.pent\"\nmaterial = {}\n").find("material"),
              std::string::npos);
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
