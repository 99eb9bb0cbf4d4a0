#include "draw.h"

#include "draw_bodies.h"
#include "draw_motions.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <tuple>

namespace pent::scene_fuzz {

namespace {

// Every key that scene files know is a line of the tables below; scene_fuzz_test.cpp compares them
// with what the simulator writes.

// --------------------------------------------------------------------------- obstacles and contact

Json contact_distance(Random& /*random*/, const Plan& plan) {
    return plan.distance;
}

Json draw_obstacle(Random& random, const Plan& plan) {
    const double gap = plan.distance * random.pick({0.5, 0.9, 1.2, 3.0});
    const double reach = plan.reach();
    const double which = random.share();
    Json obstacle = Json::object();
    if (which < 0.5) {
        obstacle["half_space"] = {{"normal", unit(1, random.chance(0.2) ? 2 : 1, plan.dimension)}};
        obstacle["half_space"]["offset"] = Random::short_of(plan.lowest() - gap);
    } else if (which < 0.7) {
        const double radius = Random::short_of(plan.size * random.number(0.5, 4));
        obstacle["ball"] = {
            {"center", as_json({0, plan.lowest() - radius - gap, 0, 0}, plan.dimension)},
            {"radius", radius}};
    } else if (which < 0.8) {
        obstacle["cavity"] = {{"center", as_json({}, plan.dimension)},
                              {"radius", Random::short_of(reach + gap)}};
    } else if (which < 0.9) {
        const double side = Random::short_of(plan.size * random.number(0.5, 4));
        const bool is_turned = random.chance(0.5);
        const double below = is_turned ? side : 0.5 * side;  // a corner is no farther than a side
        Json sides = as_json({side, side, side, side}, plan.dimension);
        obstacle["box"] = {
            {"center", as_json({0, plan.lowest() - below - gap, 0, 0}, plan.dimension)},
            {"sides", sides}};
        if (is_turned) {
            obstacle["rotate"] = draw_turns(random, plan);
        }
    } else {
        obstacle["bowl"] = {{"center", as_json({0, 0.2 * plan.size, 0, 0}, plan.dimension)},
                            {"radius", Random::short_of(1.2 * reach + gap)}};
        if (random.chance(0.3)) {
            obstacle["bowl"]["up"] = as_json({0.2, 1, 0, 0}, plan.dimension);
        }
    }
    if (random.chance(0.25)) {
        obstacle["motion"] = draw_motion(random, plan);
    }
    obstacle.update(draw_table({{"distance", 0.9, contact_distance},
                                {"stiffness", 0.9, contact_stiffness},
                                {"friction", 0.2, number(0, 1)}},
                               random, plan));
    return obstacle;
}

const Keys kBodyPair = {
    {"first", 1, [](Random&, const Plan& plan) -> Json { return plan.bodies.front().name; }},
    {"second", 1,
     [](Random& random, const Plan& plan) -> Json {
         return plan.bodies[random.below(plan.bodies.size())].name;
     }},
};

const Keys kContact = {
    {"model", 0.9, one_of({"penalty", "barrier"})},
    {"distance", 0.95, contact_distance},
    {"stiffness", 0.9, contact_stiffness},
    {"self", 0.5, flag()},
    {"filter", 0.3, one_of({"clamp", "absolute", "none"})},
    {"separation", 0.15,
     [](Random& random, const Plan& plan) -> Json {
         return Random::short_of(plan.distance * random.number(0, 0.25));
     }},
    {"friction", 0.5, number(0, 1)},
    {"slip_speed", 0.3, magnitude(1e-4, 0.1)},
    {"ignore", 0.1, tables(kBodyPair)},
    {"only", 0.05, tables(kBodyPair)},
};

// ---------------------------------------------------------------------------- damping, sleep, rest

const Keys kDamping = {
    {"mass", 0.7,
     [](Random& random, const Plan& plan) -> Json {
         return random.magnitude(0.01 / plan.dt(), 1 / plan.dt());
     }},
    {"stiffness", 0.6,
     [](Random& random, const Plan& plan) -> Json {
         return random.magnitude(0.01 * plan.dt(), plan.dt());
     }},
};

const Keys kSleep = {
    {"speed", 0.9, magnitude(0.01, 1)},
    {"time", 0.95,
     [](Random& random, const Plan& plan) -> Json {
         return Random::short_of(plan.dt() * random.number(0.5, 4));
     }},
};

const Keys kSolver = {
    {"preset", 0.2, one_of({"fast", "balanced", "accurate"})},
    {"integrator", 0.85,
     one_of({"linear_euler", "newton_euler", "newton_euler", "bdf2", "bdf2", "quasistatic"})},
    {"elements", 0.5, one_of({"linear", "smoothed", "quadratic"})},
    {"filter", 0.3, one_of({"clamp", "absolute", "none"})},
    {"linear", 0.3, one_of({"cg", "direct"})},
    {"preconditioner", 0.4, one_of({"block-jacobi", "column-jacobi", "rigid-modes"})},
    {"precision", 0.3, one_of({"float", "double"})},
    {"tolerance", 0.3, magnitude(1e-6, 1e-2)},
    {"newton_tolerance", 0.3, magnitude(1e-6, 1e-2)},
    {"max_iterations", 0.1, whole(20, 3000)},
    {"max_halvings", 0.95, whole(0, 2)},  // what diverges is to do so soon
};

const Keys kOutput = {
    {"vertex", 0.7,
     [](Random& random, const Plan&) {
         Json names = Json::array();
         for (const char* name : {"contact_force", "reaction", "energy_density"}) {
             if (random.chance(0.5)) {
                 names.push_back(name);
             }
         }
         return names;
     }},
    {"contact_pairs", 0.6, flag()},
    {"balance", 0.4, flag()}};

// ------------------------------------------------------------------------------ what goes together

std::string integrator_of(const Json& scene) {
    const Json solver = scene.value("solver", Json::object());
    const char* standard = solver.value("preset", "") == "accurate" ? "bdf2" : "linear_euler";
    return solver.value("integrator", standard);
}

bool is_held(const Json& scene, const std::string& body) {
    for (const Json& constraint : scene["constraint"]) {
        if (constraint["body"] == body) {
            return true;
        }
    }
    return false;
}

// A quadratic pentachoron has 16 children: more tesseracts than these in contact with themselves
// everywhere make a step take a minute.
bool is_too_large_in_parts(const Plan& plan, const Json& scene) {
    int tesseracts = 0;
    for (const PlannedBody& body : plan.bodies) {
        tesseracts +=
            std::accumulate(body.mesh.count.begin(), body.mesh.count.end(), 1, std::multiplies<>());
    }
    return plan.dimension == 4 && tesseracts > 4 && scene.contains("contact");
}

// A pressure of many times a body's stiffness turns it inside out in one step, which is cut until
// the scene has run out of halvings, at a high price.
void soften_pressures(Json& scene) {
    for (Json& load : scene["load"]) {
        for (const Json& body : scene["body"]) {
            const Json material = body.value("material", Json::object());
            const double young = material.contains("mu") ? 2.5 * material["mu"].get<double>()
                                                         : material.value("young", 1e5);
            if (body["name"] == load["body"] && load.contains("pressure")) {
                load["pressure"] =
                    std::clamp(load["pressure"].get<double>(), -0.5 * young, 0.5 * young);
            }
        }
    }
}

// Two bodies of which one is to be inside the other, which a barrier forbids, become so flat that
// everything is near everything: in four dimensions minutes a step.
void part_what_is_pressed_together(Json& scene) {
    for (Json& attachment : scene["attachment"]) {
        if (attachment.contains("target") && attachment.value("offset", "") == "zero") {
            attachment["contact"] = false;
        }
    }
}

// The rules that docs/simulator.md has for keys that do not go together.
void settle(Random& random, Plan& plan, Json& scene) {
    if (scene.contains("contact") && scene["contact"].value("model", "") == "barrier"
        && integrator_of(scene) == "linear_euler") {
        scene["solver"]["integrator"] =
            random.pick<const char*>({"newton_euler", "bdf2", "quasistatic"});
    }
    if (scene.value("solver", Json::object()).value("elements", "") == "smoothed") {
        scene["activation"].clear();
    }
    if (scene.value("solver", Json::object()).value("elements", "") == "quadratic"
        && is_too_large_in_parts(plan, scene)) {
        scene["solver"].erase("elements");
    }
    soften_pressures(scene);
    if (plan.dimension == 4) {
        part_what_is_pressed_together(scene);
    }
    if (scene.value("solver", Json::object()).value("elements", "") == "quadratic") {
        for (Json& body : scene["body"]) {
            body["mesh"] = "quadratic-" + body["mesh"].get<std::string>();
        }
    }
    if (integrator_of(scene) != "quasistatic") {
        return;
    }
    scene.erase("sleep");
    for (Json& constraint : scene["constraint"]) {  // they have to last
        constraint.erase("from");
        constraint.erase("to");
    }
    for (plan.body = 0; plan.body < plan.bodies.size(); ++plan.body) {
        if (!is_held(scene, plan.now().name)) {
            scene["constraint"].push_back(draw_table(kConstraint, random, plan));
            scene["constraint"].back().erase("from");
            scene["constraint"].back().erase("to");
        }
    }
}

}  // namespace

Json draw_scene(std::uint64_t seed) {
    Random random(seed);
    Plan plan = make_plan(random);
    Json scene = Json::object();
    scene["scene"] = draw_table(kScene, random, plan);
    if (plan.is_calm) {
        scene["scene"].erase("gravity");
    }
    scene["body"] = Json::array();
    scene["constraint"] = Json::array();
    scene["load"] = Json::array();
    for (plan.body = 0; plan.body < plan.bodies.size(); ++plan.body) {
        scene["body"].push_back(draw_table(kBody, random, plan));
        if (random.chance(0.25)) {
            scene["constraint"].push_back(draw_table(kConstraint, random, plan));
        }
        if (random.chance(0.2)) {
            scene["load"].push_back(draw_load(random, plan));
        }
    }
    scene["attachment"] = Json::array();
    scene["activation"] = Json::array();
    for (plan.body = 0; plan.body < plan.bodies.size(); ++plan.body) {
        if (random.chance(0.2)) {
            scene["activation"].push_back(draw_activation(random, plan));
        }
        if (random.chance(0.2)) {
            scene["attachment"].push_back(draw_attachment(random, plan));
        }
    }
    scene["obstacle"] = Json::array();
    for (int i = random.pick({0, 0, 1, 1, 2}); i > 0; --i) {
        scene["obstacle"].push_back(draw_obstacle(random, plan));
    }
    const std::vector<std::tuple<const char*, double, const Keys*>> blocks = {
        {"contact", 0.75, &kContact},
        {"damping", 0.3, &kDamping},
        {"sleep", plan.is_calm ? 0.8 : 0.4, &kSleep},
        {"solver", 0.95, &kSolver},
        {"output", 0.6, &kOutput}};
    for (const auto& [name, chance, keys] : blocks) {
        if (random.chance(chance)) {
            scene[name] = draw_table(*keys, random, plan);
        }
    }
    settle(random, plan, scene);
    return scene;
}

}  // namespace pent::scene_fuzz
