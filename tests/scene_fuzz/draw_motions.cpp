#include "draw_motions.h"

#include <cmath>
#include <string>

namespace pent::scene_fuzz {

namespace {

// A turn a run, at most.
Json turn_rate(Random& random, const Plan& plan) {
    return Random::short_of(random.number(-60, 60) / plan.duration());
}

}  // namespace

const Keys kSpin = {{"plane", 1, plane}, {"degrees_per_s", 1, turn_rate}};

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

namespace {

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

}  // namespace

Json draw_selections(Random& random, const Plan& plan) {
    const double which = random.share();
    if (which < 0.2) {
        return "everything";
    }
    Json selection = draw_selection(random, plan);
    return which < 0.7 ? selection : Json::array({selection, draw_selection(random, plan)});
}

namespace {

Json motion_velocity(Random& random, const Plan& plan) {
    return random_vector(random, plan, Random::short_of(0.3 * plan.size / plan.duration()));
}

}  // namespace

// A moment in the first half of a run, and one behind it; now and then where a step ends, or next
// to it, as times are rounded.
Json early(Random& random, const Plan& plan) {
    const double time = Random::short_of(random.number(0, 0.5) * plan.duration());
    return random.chance(0.4) ? std::floor(time / plan.dt()) * plan.dt() : time;
}

Json late(Random& random, const Plan& plan) {
    const double time = Random::short_of(random.number(0.6, 1.2) * plan.duration());
    return random.chance(0.4) ? std::ceil(time / plan.dt()) * plan.dt() : time;
}

const Keys kMotion = {
    {"translate", 0.6, motion_velocity},
    {"rotate", 0.4, tables(kSpin)},
    {"about", 0.3,
     [](Random& random, const Plan& plan) { return random_vector(random, plan, plan.size); }},
    {"from", 0.3, early},
    {"to", 0.3, late},
};

namespace {

const Keys kTurn = {{"plane", 1, plane}, {"degrees", 1, number(-180, 180)}};
const Keys kSmallTurn = {{"plane", 1, plane}, {"degrees", 1, number(-40, 40)}};

// A motion through keyframes in place of rates, all behind what early() may draw.
Json through_keyframes(const Json& rates, Random& random, const Plan& plan) {
    Json motion = Json::object();
    for (const char* key : {"about", "from"}) {
        if (rates.contains(key)) {
            motion[key] = rates[key];
        }
    }
    double time = 0.51 * plan.duration();
    for (int i = random.pick({1, 2, 3}); i > 0; --i) {
        Json keyframe = {{"time", time},
                         {"translate", random_vector(random, plan, 0.2 * plan.size)}};
        if (random.chance(0.5)) {
            keyframe["rotate"] = tables(kSmallTurn)(random, plan);
        }
        if (random.chance(0.4)) {
            keyframe["velocity"] = motion_velocity(random, plan);
        }
        motion["keyframes"].push_back(keyframe);
        time += random.number(0.1, 0.4) * plan.duration();
    }
    return motion;
}

}  // namespace

// Motions, or the word for none.
Json draw_motion(Random& random, const Plan& plan) {
    if (random.chance(0.3)) {
        return "fixed";
    }
    Json motions = tables(kMotion)(random, plan);
    if (random.chance(0.25)) {
        Json& one = motions.is_array() ? motions.back() : motions;
        one = through_keyframes(one, random, plan);
    }
    return motions;
}

Json draw_turns(Random& random, const Plan& plan) {
    return tables(kTurn)(random, plan);
}

const Keys kConstraint = {
    {"body", 1, [](Random&, const Plan& plan) -> Json { return plan.now().name; }},
    {"select", 1, draw_selections},
    {"motion", 0.8, draw_motion},
    {"from", 0.25, early},
    {"to", 0.25, late},
};

}  // namespace pent::scene_fuzz
