#include "plan.h"

#include <algorithm>

namespace pent::scene_fuzz {

namespace {

MeshName draw_mesh(Random& random, int dimension, double size) {
    MeshName mesh;
    mesh.dimension = dimension;
    mesh.kind = random.pick<const char*>(
        {"box", "box", "box", "layered", "regions", "fork", "simplex", "pieces"});
    const bool needs_three = mesh.kind == "fork" || mesh.kind == "pieces";
    int cubes = dimension == 3 ? 8 : 4;  // at most
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(dimension); ++axis) {
        int count = random.whole(1, std::min(cubes, 2));
        if (needs_three && axis < 2) {
            count = axis == 0 ? 3 : 2;
        }
        mesh.count[axis] = count;
        cubes = std::max(1, cubes / count);
        // Cells that are no cubes, but no slivers either.
        mesh.size[axis] =
            Random::short_of(size * (random.chance(0.5) ? 1 : random.number(0.5, 1.5)));
    }
    if (mesh.kind == "simplex") {
        mesh.count = {1, 1, 1, 1};
    }
    return mesh;
}

PlannedBody draw_body(Random& random, const Plan& plan) {
    PlannedBody body;
    body.mesh = draw_mesh(random, plan.dimension, plan.size);
    body.scale = random.chance(0.2) ? random.number(0.5, 2) : 1;
    body.is_turned = random.chance(0.3);
    double squared = 0;
    for (std::size_t axis = 0; axis < 4; ++axis) {
        body.half[axis] = body.scale * body.mesh.size[axis] / 2;
        squared += body.half[axis] * body.half[axis];
    }
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(plan.dimension); ++axis) {
        body.half[axis] = body.is_turned ? std::sqrt(squared) : body.half[axis];
    }
    return body;
}

// One behind the other along the axis, exactly or somewhat aside.
void line_up(Random& random, Plan& plan) {
    const auto axis = static_cast<std::size_t>(plan.axis);
    const bool is_aside = random.chance(0.5);
    double end = 0;
    for (PlannedBody& body : plan.bodies) {
        body.center[axis] = Random::short_of(end + body.half[axis]);
        end = body.center[axis] + body.half[axis] + plan.gap;
        for (std::size_t other = 0; other < static_cast<std::size_t>(plan.dimension); ++other) {
            if (other != axis && is_aside) {
                body.center[other] = random.number(-0.3 * plan.size, 0.3 * plan.size);
            }
        }
    }
}

// Towards the middle of all, so that they meet within the run; one alone if the scene is calm.
void send_off(Random& random, Plan& plan) {
    const auto axis = static_cast<std::size_t>(plan.axis);
    const double middle = (plan.bodies.front().center[axis] + plan.bodies.back().center[axis]) / 2;
    const double fast = plan.size / plan.duration();
    for (PlannedBody& body : plan.bodies) {
        if (plan.is_calm ? &body != &plan.bodies.back() : random.chance(0.4)) {
            continue;
        }
        const double sign = body.center[axis] > middle ? -1 : 1;
        body.velocity[axis] = sign * random.number(0, 0.8) * fast;
        for (std::size_t i = 0; i < static_cast<std::size_t>(plan.dimension); ++i) {
            body.velocity[i] += random.chance(0.3) ? random.number(-0.3, 0.3) * fast : 0;
            body.velocity[i] = Random::short_of(body.velocity[i]);
        }
    }
}

}  // namespace

double Plan::lowest() const {
    double low = bodies.front().center[1] - bodies.front().half[1];
    for (const PlannedBody& of : bodies) {
        low = std::min(low, of.center[1] - of.half[1]);
    }
    return low;
}

double Plan::reach() const {
    double most = 0;
    for (const PlannedBody& of : bodies) {
        double squared = 0;
        for (std::size_t axis_of = 0; axis_of < 4; ++axis_of) {
            squared += std::pow(std::abs(of.center[axis_of]) + of.half[axis_of], 2);
        }
        most = std::max(most, std::sqrt(squared));
    }
    return most;
}

Plan make_plan(Random& random) {
    static constexpr std::array<const char*, 4> kNames = {"a", "b-1", "C_2", "4d"};
    Plan plan;
    plan.dimension = random.chance(0.6) ? 3 : 4;
    plan.steps_per_frame = random.pick({1, 1, 2, 3});
    plan.frames = random.whole(3, 12 / plan.steps_per_frame);
    plan.frames_per_second = random.pick({30.0, 60.0, 100.0, 240.0, 1000.0});
    plan.size = random.magnitude(0.1, 1);
    plan.edge = plan.size / 2;
    plan.distance = Random::short_of(plan.edge * random.number(0.05, 0.25));
    plan.gap = plan.distance * random.pick({-0.5, 0.3, 0.3, 0.5, 0.5, 0.9, 0.9, 1.5, 1.5, 4.0});
    plan.is_calm = random.chance(0.3);
    plan.axis = random.pick({0, 1, 1, 1, plan.dimension - 1});
    const int count = random.pick({1, 2, 2, 2, 3, 3, 4});
    for (int i = 0; i < count; ++i) {
        plan.bodies.push_back(draw_body(random, plan));
        plan.bodies.back().name = kNames[static_cast<std::size_t>(i)];
    }
    line_up(random, plan);
    send_off(random, plan);
    return plan;
}

}  // namespace pent::scene_fuzz
