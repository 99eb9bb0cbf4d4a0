#include "draw_bodies.h"

#include "draw_motions.h"

#include <algorithm>
#include <string>

namespace pent::scene_fuzz {

namespace {

// Every key that scene files know is a line of the tables below; scene_fuzz_test.cpp compares them
// with what the simulator writes.

// ------------------------------------------------------------------------------------------- scene

Json gravity(Random& random, const Plan& plan) {
    return random.chance(0.8) ? as_json({0, -9.8, 0, 0}, plan.dimension)
                              : random_vector(random, plan, 10);
}

}  // namespace

const Keys kScene = {
    {"dimension", 1, [](Random&, const Plan& plan) -> Json { return plan.dimension; }},
    {"gravity", 0.6, gravity},
    {"frames", 1, [](Random&, const Plan& plan) -> Json { return plan.frames; }},
    {"frames_per_second", 1,
     [](Random&, const Plan& plan) -> Json { return plan.frames_per_second; }},
    {"steps_per_frame", 1, [](Random&, const Plan& plan) -> Json { return plan.steps_per_frame; }},
};

namespace {

// ------------------------------------------------------------------------------------------ bodies

const Keys kPlace = {
    {"scale", 1, [](Random&, const Plan& plan) -> Json { return plan.now().scale; }},
    {"rotate", 1,
     [](Random& random, const Plan& plan) -> Json {
         return plan.now().is_turned ? draw_turns(random, plan) : Json::array();
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

// Half of a body along an axis, by the centers of its cells.
Json half_selection(Random& random, const Plan& plan) {
    const PlannedBody& body = plan.now();
    const auto axis = random.below(static_cast<std::size_t>(plan.dimension));
    const double sign = random.pick({-1.0, 1.0});
    return {{"half_space",
             {{"normal", unit(static_cast<int>(axis), sign, plan.dimension)},
              {"offset", sign * body.center[axis]}}}};
}

Json half_or_all(Random& random, const Plan& plan) {
    return random.chance(0.4) ? Json("everything") : half_selection(random, plan);
}

Json draw_regions(Random& random, const Plan& plan) {
    Json regions = Json::array();
    for (int i = random.pick({1, 1, 2}); i > 0; --i) {
        regions.push_back({{"name", "r" + std::to_string(i)},
                           {"select", half_selection(random, plan)},
                           {"material", draw_material(random, plan)}});
    }
    return regions;
}

}  // namespace

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
    {"region", 0.2, draw_regions},
};

namespace {

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

}  // namespace

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

// ------------------------------------------------------------------------------------ activations

// What goes together: fibers and their directions, signals and their numbers.
Json draw_activation(Random& random, const Plan& plan) {
    Json activation = {{"body", plan.now().name},
                       {"select", half_or_all(random, plan)},
                       {"stretch", random.number(0.7, 1.3)}};
    const std::string fibers = random.pick({"none", "constant", "constant", "distance"});
    const std::string signal = random.pick({"constant", "sine", "sine", "pulses"});
    const bool is_periodic = signal == "sine" || signal == "pulses";
    activation["signal"] = signal;
    if (fibers != "none" || random.chance(0.5)) {
        activation["fibers"] = fibers;
    }
    if (fibers == "constant") {
        activation["direction"] = unit(random.pick({0, 1, 2}), 1, plan.dimension);
    }
    if (fibers == "distance") {
        activation["away_from"] = half_space_selection(random, plan);
        if (is_periodic && random.chance(0.5)) {
            activation["distance_wave"] = Random::short_of(random.number(-1, 1) / plan.size);
        }
    }
    if (fibers != "none" && random.chance(0.5)) {
        activation["preserves_volume"] = random.chance(0.5);
    }
    if (is_periodic) {
        activation["frequency"] = Random::short_of(random.number(0.5, 2) / plan.duration());
        if (random.chance(0.5)) {
            activation["phase"] = random.number(0, 1);
        }
        if (random.chance(0.5)) {
            activation["wave"] = random_vector(random, plan, Random::short_of(1 / plan.size));
        }
    }
    if (signal == "pulses" && random.chance(0.7)) {
        activation["duty"] = random.number(0.1, 0.9);
    }
    if (random.chance(0.3)) {
        activation["keyframes"] = draw_keyframes(random, plan);
    }
    return activation;
}

// ------------------------------------------------------------------------------------ attachments

// Newtons a meter that go with the bodies' stiffness, which is not known here: with their mass.
Json contact_stiffness(Random& random, const Plan& plan) {
    const double mass = 1000 * std::pow(plan.size, plan.dimension) / 10;  // a vertex
    return Random::short_of(mass / (plan.dt() * plan.dt()) * random.magnitude(0.003, 3));
}

namespace {

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
    {"motion", 0.4, draw_motion},
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

}  // namespace

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

}  // namespace pent::scene_fuzz
