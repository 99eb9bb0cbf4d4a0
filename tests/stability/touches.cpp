#include "small_body.h"
#include "support/crossing_checker.h"

#include <algorithm>
#include <array>

namespace pent::stability {

namespace {

using simulator::ContactModel;
using simulator::Precision;
using simulator::Scene;
using simulator::Simulation;

constexpr int kSteps = 10;
constexpr double kDt = 0.01;  // s

Scene scene_of(const Touch& touch, const Extreme& body, ContactModel model, Precision precision) {
    Scene scene = scene_of(body, precision);
    simulator::Body other = scene.bodies[0];
    other.name = "other";
    other.place.translate = Eigen::Vector4d(1 + touch.gap, touch.shift, touch.shift, touch.shift);
    other.velocity = -touch.speed * Eigen::Vector4d::UnitX();
    other.material.lame.mu *= touch.ratio;
    other.material.lame.lambda *= touch.ratio;
    scene.bodies.push_back(other);
    scene.contact =
        simulator::ContactSettings{.model = model, .distance = touch.distance, .stiffness = 100};
    scene.solver.integrator = simulator::Integrator::NewtonEuler;
    scene.frames_per_second = 1 / kDt;
    return scene;
}

// Total momentum, less that of the start, over the sum of the sizes of all momenta.
double momentum_error(const Simulation<4>& simulation, const Eigen::Vector4d& start) {
    Eigen::Vector4d momentum = -start;
    double scale = start.norm();
    for (int body = 0; body < simulation.body_count(); ++body) {
        momentum += simulation.velocities(body) * simulation.masses(body);
        scale += (simulation.velocities(body).colwise().norm() * simulation.masses(body)).value();
    }
    return scale > 0 ? momentum.norm() / scale : 0;
}

int crossings(const Simulation<4>& simulation) {
    Positions<4> all(4, simulation.positions(0).cols() + simulation.positions(1).cols());
    all << simulation.positions(0), simulation.positions(1);
    const auto surface = [&](int body) {
        const SimplexMesh<4>& mesh = simulation.mesh(body);
        return contact::make_surface<4>(mesh.cells, mesh.vertex_count(),
                                        static_cast<std::uint32_t>(simulation.first_vertex(body)));
    };
    return pent::test::count_crossings<4>(surface(0), surface(1), all);
}

Outcome simulate(const Touch& touch,
                 simulator::ElementKind elements,
                 ContactModel model,
                 Precision precision) {
    Extreme body;
    body.cells = touch.cells;
    body.elements = elements;
    const Scene scene = scene_of(touch, body, model, precision);
    const SimplexMesh<4> mesh = mesh_of(body);
    Simulation<4> simulation(scene, {mesh, mesh});
    const Eigen::Vector4d momentum = simulation.velocities(1) * simulation.masses(1);
    Outcome outcome = step_all(simulation, kSteps - 1);
    if (outcome.kind != Outcome::Kind::Right) {
        return outcome;
    }
    const simulator::StepReport last = simulation.step();
    if (!last.is_accepted) {
        return {.kind = Outcome::Kind::Reported, .error = 0, .reason = last.failure};
    }
    outcome = judge(momentum_error(simulation, momentum), precision);
    const double world = 100 + touch.speed * kDt * kSteps;
    const double farthest = std::max(simulation.positions(0).cwiseAbs().maxCoeff(),
                                     simulation.positions(1).cwiseAbs().maxCoeff());
    if (farthest > world || (model == ContactModel::Barrier && crossings(simulation) > 0)) {
        outcome.kind = Outcome::Kind::Wrong;
    }
    const double deepest_at_start = std::max(0.0, -touch.gap);
    if (outcome.kind == Outcome::Kind::Right
        && last.contact.deepest > deepest_at_start + bound(precision)) {
        return {.kind = Outcome::Kind::Reported,
                .error = 0,
                .reason = "the bodies are in one another (deepest)"};
    }
    return outcome;
}

}  // namespace

std::vector<Touch> touches(simulator::ElementKind elements) {
    std::vector<Touch> all = {
        {.name = "contact within 1e-9 edges", .gap = 0.05, .distance = 1e-9},
        {.name = "contact within 1e-9 edges, nearer than that", .gap = 5e-10, .distance = 1e-9},
        {.name = "contact within 1e-3 edges", .gap = 5e-4, .distance = 1e-3},
        {.name = "contact within half an edge", .gap = 0.25, .distance = 0.5},
        {.name = "contact within 10 edges", .gap = 0.5, .distance = 10, .cells = 0},
        {.name = "touching at distance zero", .gap = 0},
        {.name = "exactly parallel faces", .gap = 0.05, .distance = 0.1, .shift = 0},
        {.name = "coincident faces and edges", .gap = 0, .distance = 0.1, .shift = 0},
        {.name = "overlapping by a tenth of an edge", .gap = -0.1},
        {.name = "one body within the other", .gap = -1, .distance = 0.1, .shift = 0},
        {.name = "one 1e6 times stiffer than the other", .ratio = 1e6},
        {.name = "meeting at 10 edges a second", .gap = 0.3, .speed = 10},
        {.name = "meeting at 1e4 edges a second", .gap = 0.3, .speed = 1e4}};
    if (elements == simulator::ElementKind::Quadratic) {
        all.erase(std::remove_if(all.begin(), all.end(),
                                 [](const Touch& touch) {
                                     return touch.distance >= 0.5 || touch.speed > 100;
                                 }),
                  all.end());
    }
    return all;
}

Outcome run(const Touch& touch,
            simulator::ElementKind elements,
            ContactModel model,
            Precision precision) {
    return guarded([&] { return simulate(touch, elements, model, precision); });
}

}  // namespace pent::stability
