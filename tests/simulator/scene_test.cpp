#include "scenes.h"
#include "support/messages.h"

#include <pent/error.h>
#include <pent/simulator/scene.h>

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

// What check() refuses, for hosts that fill in a scene themselves.

namespace pent::simulator {
namespace {

using pent::test::error_of;
using test::box_scene;
using test::hold;
using test::still;

TEST(CheckScene, NamesTheBodyWhoseMaterialIsOutOfRange) {
    Scene scene = box_scene<4>();
    scene.bodies[0].material.density = 0;
    pent::test::expect_contains(pent::test::error_of([&] { check(scene); }),
                                {"body \"box\": the density is 0", "more than 0"});
}

struct BadScene {
    std::function<void(Scene&)> spoil;
    std::vector<std::string> told;
};

TEST(CheckScene, TakesAScene) {
    EXPECT_NO_THROW(check(box_scene<3>()));
    EXPECT_NO_THROW(check(box_scene<4>()));
}

TEST(CheckScene, SaysWhatIsWrongAndWhatWasExpected) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<BadScene> bad = {
        {[](Scene& s) { s.dimension = 5; }, {"scene", "dimension", "5"}},
        {[](Scene& s) { s.bodies.clear(); }, {"the scene has no body"}},
        {[](Scene& s) { s.frames_per_second = 0; }, {"frames_per_second", "0", "above 0"}},
        {[&](Scene& s) { s.gravity[1] = nan; }, {"gravity", "4 finite numbers"}},
        {[](Scene& s) { s.gravity = Eigen::Vector3d::Zero(); }, {"gravity", "4 finite numbers"}},
        {[](Scene& s) { s.bodies.push_back(s.bodies[0]); }, {"two bodies have the name \"box\""}},
        {[](Scene& s) { s.bodies[0].name = "a/b"; }, {"\"a/b\"", "letters, digits"}},
        {[](Scene& s) { s.bodies[0].name = std::string(101, 'a'); }, {"at most 100"}},
        {[](Scene& s) {
             s.constraints = {hold(EverythingSelection{}, still(4))};
             s.constraints[0].body = "bar";
         },
         {"constraint on \"bar\"", "no body has this name"}},
        {[](Scene& s) { s.contact = ContactSettings{.distance = -1}; },
         {"contact", "distance", "-1"}},
        {[](Scene& s) { s.contact = ContactSettings{.model = ContactModel::Barrier}; },
         {"barrier", "newton_euler"}},
        {[](Scene& s) {
             s.sleep = Sleep{};
             s.solver.integrator = Integrator::Quasistatic;
         },
         {"quasistatic"}},
        {[](Scene& s) { s.solver.integrator = Integrator::Quasistatic; },
         {"\"box\" has no constraint"}},
        {[](Scene& s) { s.solver.tolerance = 0; }, {"tolerance", "0", "above 0 and below 1"}},
        {[](Scene& s) { s.constraints = {hold(LayerSelection{.first = 3, .last = 1}, still(4))}; },
         {"constraint on \"box\"", "\"last\" is before \"first\""}},
        {[](Scene& s) {
             s.obstacles = {
                 {.shape = BallObstacle{.center = Eigen::Vector4d::Zero(), .radius = -1}}};
         },
         {"obstacle", "radius", "above 0"}},
        {[](Scene& s) {
             const Region region{.name = "tip",
                                 .select = {EverythingSelection{}},
                                 .material = s.bodies[0].material};
             s.bodies[0].regions = {region, region};
         },
         {"body \"box\"", "two regions have the name \"tip\""}},
        {[](Scene& s) {
             s.bodies[0].regions = {{.name = "a b",
                                     .select = {EverythingSelection{}},
                                     .material = s.bodies[0].material}};
         },
         {"body \"box\"", "the region \"a b\"", "letters, digits"}},
        {[](Scene& s) { s.gravity.resize(0); }, {"gravity", "4 finite numbers"}},
        {[](Scene& s) { s.bodies[0].place.scale = 0; }, {"\"box\"", "scale", "above 0"}},
        {[](Scene& s) {
             s.activations = {{.body = "box", .select = {EverythingSelection{}}, .stretch = 1.1}};
             s.solver.elements = ElementKind::Smoothed;
         },
         {"activation", "smoothed"}},
        {[](Scene& s) {
             s.activations = {{.body = "bar", .select = {EverythingSelection{}}, .stretch = 1.1}};
         },
         {"activation of \"bar\"", "no body has this name"}},
        {[](Scene& s) {
             s.loads = {{.body = "bar", .select = {EverythingSelection{}}, .pressure = 1}};
         },
         {"load on \"bar\"", "no body has this name"}},
        {[](Scene& s) {
             s.attachments = {
                 {.body = "bar", .select = {EverythingSelection{}}, .point = {}, .motion = {}}};
         },
         {"attachment of \"bar\"", "no body is called \"bar\""}},
        {[](Scene& s) {
             s.attachments = {{.body = "box",
                               .select = {EverythingSelection{}},
                               .target = "bar",
                               .point = {},
                               .motion = {}}};
         },
         {"attachment of \"box\"", "no body is called \"bar\""}},
    };
    for (const BadScene& entry : bad) {
        Scene scene = box_scene<4>();
        entry.spoil(scene);
        const std::string message = error_of([&] { check(scene); });
        for (const std::string& part : entry.told) {
            pent::test::expect_contains(message, {part});
        }
    }
}

// Each is what SaysWhatIsWrong spoils, as it may be.
TEST(CheckScene, TakesPartsOfBodiesThatThereAre) {
    Scene scene = box_scene<4>();
    scene.bodies.push_back(scene.bodies[0]);
    scene.bodies[1].name = std::string(100, 'b');
    const std::vector<Selection> all = {EverythingSelection{}};
    scene.constraints = {hold(EverythingSelection{}, still(4))};
    scene.activations = {{.body = "box", .select = all, .stretch = 1.1}};
    scene.loads = {{.body = "box", .select = all, .pressure = 1}};
    scene.attachments = {
        {.body = "box", .select = all, .point = {}, .motion = {}},
        {.body = "box", .select = all, .target = scene.bodies[1].name, .point = {}, .motion = {}}};
    scene.contact = ContactSettings{.model = ContactModel::Barrier};
    scene.sleep = Sleep{};
    scene.solver.integrator = Integrator::NewtonEuler;
    EXPECT_NO_THROW(check(scene));
    scene.solver.integrator = Integrator::LinearEuler;
    scene.contact->model = ContactModel::Penalty;
    EXPECT_NO_THROW(check(scene));
}

TEST(CheckScene, WantsEveryBodyHeldAllTheTimeInStaticsAlone) {
    const auto held = [](double from, double to, const std::string& body) {
        Scene scene = box_scene<4>();
        scene.bodies.push_back(scene.bodies[0]);
        scene.bodies[1].name = "other";
        scene.solver.integrator = Integrator::Quasistatic;
        scene.constraints = {hold(EverythingSelection{}, still(4)),
                             hold(EverythingSelection{}, still(4))};
        scene.constraints[1].body = body;
        scene.constraints[1].from = from;
        scene.constraints[1].to = to;
        return scene;
    };
    const double forever = std::numeric_limits<double>::infinity();
    EXPECT_NO_THROW(check(held(0, forever, "other")));
    for (const Scene& scene :
         {held(1, forever, "other"), held(0, 1, "other"), held(0, forever, "box")}) {
        pent::test::expect_contains(error_of([&] { check(scene); }),
                                    {"\"other\" has no constraint that lasts"});
    }
}

}  // namespace
}  // namespace pent::simulator
