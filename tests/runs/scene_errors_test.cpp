#include "scene_text.h"

#include <gtest/gtest.h>

namespace pent::runs {
namespace {

using namespace simulator;
using test::error_of;
using test::parse;
using test::with;

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
                 "rotate = { plane = \"xv\", degrees = 9 }\n"),
            "scene.toml:7:20:"},
        Bad{with("[[obstacle]]\nbox = { center = [0,0,0,0], sides = [1,1,1,1], axes = [1] }\n"),
            "\"axes\""},
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

}  // namespace
}  // namespace pent::runs
