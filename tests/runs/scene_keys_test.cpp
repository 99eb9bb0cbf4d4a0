#include "scene_text.h"
#include "support/messages.h"

#include <pent/runs/scene_file.h>
#include <pent/runs/scene_keys.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace pent::runs {
namespace {

using simulator::Scene;
using test::parse;
using test::with;

Scene scene_with(const std::string& block) {
    return parse(with(block));
}

std::string message_of(const Scene& scene, const std::vector<KeyValue>& keys) {
    return pent::test::error_of([&] { static_cast<void>(with_keys(scene, keys)); });
}

TEST(SceneKeys, AreThoseOfTheSchemaEachOnce) {
    const std::vector<std::string> keys = scene_keys();
    EXPECT_EQ(std::set(keys.begin(), keys.end()).size(), keys.size());
    for (const char* key :
         {"scene.gravity", "body.material.young", "body.place.scale", "body.region.material.mu",
          "constraint.select.ball.radius", "constraint.select.region", "load.keyframes.factor",
          "obstacle.half_space.offset", "contact.friction", "solver.preset", "solver.tolerance",
          "output.contact_forces"}) {
        EXPECT_EQ(std::count(keys.begin(), keys.end(), key), 1) << key;
    }
}

// Every key, whatever its type: none takes what no value is, but for those that are any text.
TEST(WithKeys, RefuseWhatNoKeyCanBe) {
    const Scene scene = scene_with("");
    for (const std::string& key : scene_keys()) {
        if (!key.ends_with(".mesh") && !key.ends_with(".recipe")) {
            EXPECT_THROW(static_cast<void>(with_keys(scene, {{key, "no such value!"}})), Error)
                << key;
        }
    }
}

TEST(WithKeys, ReachEveryBlockAndEveryEntryOfAList) {
    const Scene scene = scene_with(R"(
[[load]]
body = "a"
select = "everything"
force = [0, 1, 0, 0]
keyframes = [{ time = 0, factor = 0 }, { time = 1, factor = 1 }]
[[load]]
body = "a"
select = [{ ball = { center = [0, 0, 0, 0], radius = 1 } }, { layers = { first = 0 } },
          { region = 3 }]
pressure = 1
[[obstacle]]
half_space = { normal = [0, 1, 0, 0], offset = 1 }
[[obstacle]]
ball = { center = [0, 0, 0, 0], radius = 1 }
)");
    const Scene changed = with_keys(scene, {{"load.keyframes.factor", "0.5"},
                                            {"load.select.ball.radius", "2"},
                                            {"load.select.region", "4"},
                                            {"obstacle.half_space.offset", "3"},
                                            {"obstacle.distance", "0.5"}});
    EXPECT_EQ(changed.loads[0].keyframes[0].factor, 0.5);
    EXPECT_EQ(changed.loads[0].keyframes[1].factor, 0.5);
    EXPECT_EQ(std::get<simulator::BallSelection>(changed.loads[1].select[0]).radius, 2);
    EXPECT_EQ(std::get<simulator::RegionSelection>(changed.loads[1].select[2]).region, 4);
    EXPECT_EQ(std::get<HalfSpace<Eigen::Dynamic>>(changed.obstacles[0].shape).offset, 3);
    EXPECT_EQ(changed.obstacles[0].distance, 0.5);
    EXPECT_EQ(changed.obstacles[1].distance, 0.5);
    EXPECT_EQ(message_of(scene, {{"obstacle.cavity.radius", "1"}}),
              "the scene has no [[obstacle]] with \"cavity.radius\"");
    EXPECT_EQ(message_of(scene, {{"contact.friction", "1"}}), "the scene has no [contact]");
}

TEST(WithKeys, KeepTheOtherNumberOfAPair) {
    const Scene scene = scene_with("");
    const Scene soft = with_keys(scene, {{"body.material.young", "2e3"}});
    const auto pair = simulator::young_from_lame(4, soft.bodies[0].material.lame);
    EXPECT_NEAR(pair.young, 2e3, 1e-9);  // from Lame's constants and back: rounding
    EXPECT_NEAR(pair.poisson, 0.28, 1e-13);
    const Scene lame = with_keys(scene, {{"body.material.mu", "5"}});
    EXPECT_EQ(lame.bodies[0].material.lame.mu, 5);
    EXPECT_EQ(lame.bodies[0].material.lame.lambda, scene.bodies[0].material.lame.lambda);
}

// Keys that decide about others come first, whoever names them first.
TEST(WithKeys, DoNotDependOnTheirOrder) {
    const Scene scene = scene_with(
        "[[activation]]\nbody = \"a\"\nselect = \"everything\"\nstretch = 0.8\n"
        "[[constraint]]\nbody = \"a\"\nselect = \"everything\"\nfrom = 2\nto = 3\n");
    std::vector<KeyValue> keys = {{"activation.signal", "sine"},
                                  {"activation.frequency", "3"},
                                  {"constraint.from", "0.5"},
                                  {"constraint.to", "1"},
                                  {"body.material.model", "mooney-rivlin"},
                                  {"body.material.second_invariant", "0.25"},
                                  {"body.material.young", "2e4"},
                                  {"body.material.poisson", "0.3"},
                                  {"solver.preset", "fast"},
                                  {"solver.filter", "absolute"}};
    const std::string text = scene_text(with_keys(scene, keys));
    std::reverse(keys.begin(), keys.end());
    EXPECT_EQ(scene_text(with_keys(scene, keys)), text);
    const Scene read = with_keys(scene, keys);
    EXPECT_EQ(read.activations[0].frequency, 3);
    EXPECT_EQ(read.constraints[0].to, 1);
    EXPECT_EQ(read.solver.tolerance, 1e-2);
    EXPECT_EQ(read.solver.filter, simulator::Filter::Absolute);
}

TEST(WithKeys, SayWhatTheSchemaSays) {
    const Scene scene = scene_with(
        "[[activation]]\nbody = \"a\"\nselect = \"everything\"\nstretch = 0.8\n[contact]\n");
    EXPECT_EQ(message_of(scene, {{"solver.tolerance", "2"}}),
              "\"tolerance\" is 2; expected a number above 0 and below 1");
    EXPECT_EQ(message_of(scene, {{"solver.max_iterations", "1.5"}}),
              "\"max_iterations\" is 1.5; expected a whole number from 1 to 1000000");
    EXPECT_EQ(message_of(scene, {{"contact.self", "yes"}}),
              "\"self\" is the text \"yes\"; expected true or false");
    EXPECT_EQ(message_of(scene, {{"solver.linear", "drect"}}),
              "\"linear\" is \"drect\"; expected one of \"cg\", \"direct\"; did you mean"
              " \"direct\"?");
    EXPECT_EQ(message_of(scene, {{"activation.frequency", "1"}}),
              "\"frequency\" goes with signal = \"sine\" or \"pulses\" alone");
    EXPECT_EQ(message_of(scene, {{"body.material.model", "mooney-rivlin"}}),
              "the scene needs \"body.material.second_invariant\", too");
    EXPECT_EQ(message_of(scene, {{"solver.tolerence", "1"}}),
              "no key of scenes has the path \"solver.tolerence\"; did you mean"
              " \"solver.tolerance\"?");
    EXPECT_EQ(message_of(scene, {{"solver.tolerance", "1e-3\nfilter = \"none\""}}).find('\n'),
              std::string::npos);
    pent::test::expect_contains(
        message_of(scene, {{"contact.model", "barrier"}, {"solver.integrator", "linear_euler"}}),
        {"the barrier model needs a solver that iterates"});
}

}  // namespace
}  // namespace pent::runs
