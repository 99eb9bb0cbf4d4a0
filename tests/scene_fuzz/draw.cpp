#include "draw.h"

#include "keys.h"
#include "plan.h"

#include <algorithm>
#include <tuple>

namespace pent::scene_fuzz {

namespace {

// Every key that scene files know is a line of the tables below; scene_fuzz_test.cpp compares them
// with what the simulator writes.

// ------------------------------------------------------------------------------------------- scene

Json gravity(Random& random, const Plan& plan) {
    return random.chance(0.8) ? as_json({0, -9.8, 0, 0}, plan.dimension)
                              : random_vector(random, plan, 10);
}

const Keys kScene = {
    {"dimension", 1, [](Random&, const Plan& plan) -> Json { return plan.dimension; }},
    {"gravity", 0.6, gravity},
    {"frames", 1, [](Random&, const Plan& plan) -> Json { return plan.frames; }},
    {"frames_per_second", 1,
     [](Random&, const Plan& plan) -> Json { return plan.frames_per_second; }},
    {"steps_per_frame", 1, [](Random&, const Plan& plan) -> Json { return plan.steps_per_frame; }},
};

// ------------------------------------------------------------------------------------------ bodies

// A turn a run, at most.
Json turn_rate(Random& random, const Plan& plan) {
    return Random::short_of(random.number(-60, 60) / plan.duration());
}

const Keys kSpin = {{"plane", 1, plane}, {"degrees_per_s", 1, turn_rate}};
const Keys kTurn = {{"plane", 1, plane}, {"degrees", 1, number(-180, 180)}};

const Keys kPlace = {
    {"scale", 1, [](Random&, const Plan& plan) -> Json { return plan.now().scale; }},
    {"rotate", 1,
     [](Random& random, const Plan& plan) -> Json {
         return plan.now().is_turned ? tables(kTurn)(random, plan) : Json::array();
     }},
    {"translate", 1,
     [](Random&, const Plan& plan) { return as_json(plan.now().center, plan.dimension); }},
};

// Waves cross between a twentieth of a cell and twenty cells in a step.
double draw_young(Random& random, const Plan& plan, double density) {
    const double speed = random.magnitude(0.05, 20) * plan.edge / plan.dt();
    return Random::short_of(density * speed * speed);
}

Json draw_material(Random& random, const Plan& plan) {
    Json material = draw_table({{"model", 0.8,
                                 one_of({"stable-neo-hookean", "mooney-rivlin", "arap",
                                         "st-venant-kirchhoff", "linear"})}},
                               random, plan);
    if (material.value("model", "") == "mooney-rivlin") {
        // Its bound is 1 + lambda / mu where lambda < 0: above 0.6 for all that is drawn.
        material["second_invariant"] = random.number(0, 0.6);
    }
    const double density = random.chance(0.3) ? 1000 : random.magnitude(10, 1e4);
    const double young = draw_young(random, plan, density);
    if (random.chance(0.2)) {
        material["mu"] = Random::short_of(young / 2.5);
        material["lambda"] = Random::short_of(young * random.number(-0.1, 1));
    } else {
        material["young"] = young;
        if (random.chance(0.7)) {
            material["poisson"] = random.number(-0.3, plan.dimension == 4 ? 0.31 : 0.45);
        }
    }
    if (density != 1000) {
        material["density"] = density;
    }
    return material;
}

const Keys kBody = {
    {"name", 1, [](Random&, const Plan& plan) -> Json { return plan.now().name; }},
    {"mesh", 1, [](Random&, const Plan& plan) -> Json { return text_of(plan.now().mesh); }},
    {"recipe", 0.05,
     one_of({"a.obj --edge-length 0.1 -o a.pent", "\"quoted\" \\ name\t.obj", "--ball 1"})},
    {"place", 1, table(kPlace)},
    {"material", 0.95, draw_material},
    {"velocity", 0.9,
     [](Random&, const Plan& plan) { return as_json(plan.now().velocity, plan.dimension); }},
    {"spin", 0.25, tables(kSpin)},
    {"friction", 0.15, number(0, 1)},
};

// ------------------------------------------------------------------------------------- constraints

// Half of a body along an axis: of its box, so never nothing.
Json half_space_selection(Random& random, const Plan& plan) {
    const PlannedBody& body = plan.now();
    const auto axis = random.below(static_cast<std::size_t>(plan.dimension));
    const double sign = random.pick({-1.0, 1.0});
    const double share = body.is_turned ? 0 : random.pick({0.0, -0.9});
    const double offset = sign * body.center[axis] + share * body.half[axis];
    return {{"half_space",
             {{"normal", unit(static_cast<int>(axis), sign, plan.dimension)}, {"offset", offset}}}};
}

Json ball_selection(Random& random, const Plan& plan) {
    const PlannedBody& body = plan.now();
    Vector center = body.center;
    const std::size_t axis = random.below(static_cast<std::size_t>(plan.dimension));
    center[axis] += body.half[axis];
    double squared = 0;
    for (const double half : body.half) {
        squared += half * half;
    }
    const double radius = Random::short_of(std::sqrt(squared) * random.number(0.8, 1.2));
    return {{"ball", {{"center", as_json(center, plan.dimension)}, {"radius", radius}}}};
}

Json box_selection(Random& random, const Plan& plan) {
    const PlannedBody& body = plan.now();
    Vector low = body.center;
    Vector high = body.center;
    for (std::size_t axis = 0; axis < 4; ++axis) {
        low[axis] -= 1.1 * body.half[axis];
        high[axis] += 1.1 * body.half[axis];
    }
    high[random.below(static_cast<std::size_t>(plan.dimension))] -= plan.size;
    for (std::size_t axis = 0; axis < 4; ++axis) {
        high[axis] = std::max(high[axis], low[axis] + 0.2 * body.half[axis]);
    }
    return {
        {"box", {{"low", as_json(low, plan.dimension)}, {"high", as_json(high, plan.dimension)}}}};
}

Json draw_selection(Random& random, const Plan& plan) {
    const MeshName& mesh = plan.now().mesh;
    if (mesh.kind == "layered" && random.chance(0.6)) {
        Json layers = {{"first", 0}};
        if (random.chance(0.3)) {
            layers["last"] = 1;
        }
        return {{"layers", layers}};
    }
    if (mesh.kind == "regions" && random.chance(0.6)) {
        return {{"region", 0}};
    }
    const double which = random.share();
    return which < 0.4   ? half_space_selection(random, plan)
           : which < 0.7 ? ball_selection(random, plan)
                         : box_selection(random, plan);
}

Json draw_selections(Random& random, const Plan& plan) {
    const double which = random.share();
    if (which < 0.2) {
        return "everything";
    }
    Json selection = draw_selection(random, plan);
    return which < 0.7 ? selection : Json::array({selection, draw_selection(random, plan)});
}

Json motion_velocity(Random& random, const Plan& plan) {
    return random_vector(random, plan, Random::short_of(0.3 * plan.size / plan.duration()));
}

// A moment in the first half of a run, and one behind it.
Json early(Random& random, const Plan& plan) {
    return Random::short_of(random.number(0, 0.5) * plan.duration());
}
Json late(Random& random, const Plan& plan) {
    return Random::short_of(random.number(0.6, 1.2) * plan.duration());
}

const Keys kMotion = {
    {"translate", 0.6, motion_velocity},
    {"rotate", 0.4, tables(kSpin)},
    {"about", 0.3,
     [](Random& random, const Plan& plan) { return random_vector(random, plan, plan.size); }},
    {"from", 0.3, early},
    {"to", 0.3, late},
};

// Of what does not turn.
const Keys kSlide = {{"translate", 1, motion_velocity}, {"from", 0.3, early}, {"to", 0.3, late}};

// Motions, or the word for none.
Json draw_motion(const Keys& keys, Random& random, const Plan& plan) {
    return random.chance(0.3) ? Json("fixed") : tables(keys)(random, plan);
}
Json any_motion(Random& random, const Plan& plan) {
    return draw_motion(kMotion, random, plan);
}

const Keys kConstraint = {
    {"body", 1, [](Random&, const Plan& plan) -> Json { return plan.now().name; }},
    {"select", 1, draw_selections},
    {"motion", 0.8, any_motion},
    {"from", 0.25, early},
    {"to", 0.25, late},
};

// ------------------------------------------------------------------------------------------- loads

Json draw_keyframes(Random& random, const Plan& plan) {
    Json keyframes = Json::array();
    double time = 0;
    for (int i = random.pick({1, 2, 3}); i > 0; --i) {
        keyframes.push_back({{"time", Random::short_of(time)}, {"factor", random.number(-1, 1)}});
        time += random.number(0.2, 0.6) * plan.duration();
    }
    return keyframes;
}

// What moves a body of water by a part of its size within the run.
Json draw_load(Random& random, const Plan& plan) {
    const PlannedBody& body = plan.now();
    double mass = 1000;
    for (int axis = 0; axis < plan.dimension; ++axis) {
        mass *= 2 * body.half[static_cast<std::size_t>(axis)];
    }
    const double force = mass * plan.size / (plan.duration() * plan.duration());
    const bool has_pressure = random.chance(0.6);
    Json load = {{"body", body.name}};
    // A whole facet is certain with everything, and with half of a box.
    const bool is_box = body.mesh.kind == "box" && !body.is_turned;
    load["select"] = !has_pressure                  ? draw_selections(random, plan)
                     : is_box && random.chance(0.6) ? half_space_selection(random, plan)
                                                    : Json("everything");
    if (has_pressure) {
        load["pressure"] = Random::short_of(random.number(-0.3, 0.3) * force
                                            / std::pow(plan.size, plan.dimension - 1));
    }
    if (!has_pressure || random.chance(0.2)) {
        load["force"] = random_vector(random, plan, Random::short_of(0.3 * force));
    }
    if (random.chance(0.5)) {
        load["keyframes"] = draw_keyframes(random, plan);
    }
    return load;
}

// --------------------------------------------------------------------------- obstacles and contact

// Newtons a meter that go with the bodies' stiffness, which is not known here: with their mass.
Json contact_stiffness(Random& random, const Plan& plan) {
    const double mass = 1000 * std::pow(plan.size, plan.dimension) / 10;  // a vertex
    return Random::short_of(mass / (plan.dt() * plan.dt()) * random.magnitude(0.003, 3));
}

// To another body where there is one, or to points in space.
const Keys kAttachment = {
    {"body", 1, [](Random&, const Plan& plan) -> Json { return plan.now().name; }},
    {"select", 1, draw_selections},
    {"target", 0.6,
     [](Random&, const Plan& plan) -> Json {
         return plan.bodies[(plan.body + 1) % plan.bodies.size()].name;
     }},
    {"point", 0.3,
     [](Random& random, const Plan& plan) { return random_vector(random, plan, plan.size); }},
    {"motion", 0.4, any_motion},
    {"offset", 0.5, one_of({"keep", "zero"})},
    {"max_distance", 1, [](Random&, const Plan& plan) -> Json { return 100 * plan.reach(); }},
    {"stiffness", 0.9, contact_stiffness},
    {"damping", 0.4,
     [](Random& random, const Plan& plan) -> Json {
         return Random::short_of(contact_stiffness(random, plan).get<double>() * plan.dt());
     }},
    {"from", 0.3, early},
    {"to", 0.3, late},
    {"break_force", 0.4,
     [](Random& random, const Plan& plan) -> Json {
         return Random::short_of(contact_stiffness(random, plan).get<double>() * plan.size
                                 * random.magnitude(0.01, 1));
     }},
    {"contact", 0.3, flag()},
};

// A target is another body, and has neither point nor motion; an offset is carried no farther than
// a cell can.
Json draw_attachment(Random& random, const Plan& plan) {
    Json attachment = draw_table(kAttachment, random, plan);
    if (plan.bodies.size() == 1) {
        attachment.erase("target");
    }
    if (attachment.contains("target")) {
        attachment.erase("point");
        attachment.erase("motion");
        attachment["offset"] = "zero";
    }
    return attachment;
}

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
        Json sides = as_json({side, side, side, side}, plan.dimension);
        obstacle["box"] = {
            {"center", as_json({0, plan.lowest() - 0.5 * side - gap, 0, 0}, plan.dimension)},
            {"sides", sides}};
    } else {
        obstacle["bowl"] = {{"center", as_json({0, 0.2 * plan.size, 0, 0}, plan.dimension)},
                            {"radius", Random::short_of(1.2 * reach + gap)}};
        if (random.chance(0.3)) {
            obstacle["bowl"]["up"] = as_json({0.2, 1, 0, 0}, plan.dimension);
        }
    }
    if (random.chance(0.25)) {
        const bool turns = !obstacle.contains("box");
        obstacle["motion"] = draw_motion(turns ? kMotion : kSlide, random, plan);
    }
    obstacle.update(
        draw_table({{"distance", 0.9, contact_distance}, {"stiffness", 0.9, contact_stiffness}},
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
    {"contact_pairs", 0.6, flag()}};

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

// The rules that docs/simulator.md has for keys that do not go together.
void settle(Random& random, Plan& plan, Json& scene) {
    if (scene.contains("contact") && scene["contact"].value("model", "") == "barrier"
        && integrator_of(scene) == "linear_euler") {
        scene["solver"]["integrator"] =
            random.pick<const char*>({"newton_euler", "bdf2", "quasistatic"});
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
    for (plan.body = 0; plan.body < plan.bodies.size(); ++plan.body) {
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
