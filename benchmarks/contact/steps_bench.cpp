// Steps of scenes where contact is all there is; counters: iterations, pairs, and the share of contact
// in the time of a step.

#include "support/kuhn_box.h"

#include <pent/simulator/simulation.h>

#include <benchmark/benchmark.h>

#include <random>

namespace pent::simulator {
namespace {

constexpr double kEps = 0.025;  // a quarter of a cell

// A box of cubes of 0.1 m, columns labeled.
SimplexMesh<4> box(const std::array<int, 4>& count) {
    SimplexMesh<4> mesh = pent::test::kuhn_box<4>(
        count, {0.1 * count[0], 0.1 * count[1], 0.1 * count[2], 0.1 * count[3]});
    const auto base = static_cast<std::uint32_t>((count[0] + 1) * (count[1] + 1) * (count[2] + 1));
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        mesh.columns.push_back(v % base);
        mesh.layers.push_back(v / base);
    }
    return mesh;
}

// A body of density 1000 with E = 1e7, nu = 0.28; the linear solver goes to 1e-3.
Scene one_body() {
    Scene scene;
    scene.gravity = Eigen::Vector4d::Zero();
    Body body;
    body.name = "body";
    body.mesh = "body.pent";
    body.place.translate = Eigen::Vector4d::Zero();
    body.material.lame = lame_from_young(4, 1e7, 0.28);
    scene.bodies = {body};
    scene.contact = Contact{.distance = kEps, .stiffness = 1e4};
    scene.solver.tolerance = 1e-3;
    return scene;
}

// Two bodies of 60 x 12 x 3 x 2 cells, 207,360 pentachora in all, face to face along w at half of the
// distance of contact and pressed together at 0.5 m/s.
Scene hug_scene(bool self) {
    Scene scene = one_body();
    scene.frames_per_second = 200;
    scene.bodies.push_back(scene.bodies[0]);
    scene.bodies[1].name = "other";
    scene.bodies[0].velocity = 0.25 * Eigen::Vector4d::UnitW();
    scene.bodies[1].velocity = -0.25 * Eigen::Vector4d::UnitW();
    scene.bodies[1].place.translate = Eigen::Vector4d(0.03, 0, 0, 0.2 + 0.5 * kEps);
    scene.contact->self = self;
    return scene;
}

// Shaken by a tenth of a cell: aligned boxes are not what bodies look like.
SimplexMesh<4> hug_body(unsigned seed) {
    SimplexMesh<4> mesh = box({60, 12, 3, 2});
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> shake(-0.005, 0.005);
    for (double& x : mesh.positions.reshaped()) {
        x += shake(random);
    }
    return mesh;
}

void run_steps(benchmark::State& state,
               const Scene& scene,
               const std::vector<SimplexMesh<4>>& meshes,
               int warm_up) {
    Simulation<4> simulation(scene, meshes, {.threads = static_cast<int>(state.range(0))});
    for (int i = 0; i < warm_up; ++i) {
        benchmark::DoNotOptimize(simulation.step().is_accepted);
    }
    std::vector<Positions<4>> positions;
    std::vector<Positions<4>> velocities;
    for (int body = 0; body < simulation.body_count(); ++body) {
        positions.emplace_back(simulation.positions(body));
        velocities.emplace_back(simulation.velocities(body));
    }
    StepReport report;
    double seconds = 0;
    double contact_seconds = 0;
    for ([[maybe_unused]] auto _ : state) {
        state.PauseTiming();
        for (int body = 0; body < simulation.body_count(); ++body) {
            const auto i = static_cast<std::size_t>(body);
            simulation.set_state(body, positions[i], velocities[i]);
        }
        benchmark::DoNotOptimize(simulation.energies());
        state.ResumeTiming();
        report = simulation.step();
        seconds += report.seconds;
        contact_seconds += report.contact.seconds;
    }
    state.counters["iterations"] = report.iterations;
    state.counters["newton"] = report.newton_iterations;
    state.counters["points"] = static_cast<double>(report.contact.point_facet);
    state.counters["mixed"] = static_cast<double>(report.contact.mixed);
    state.counters["candidates"] = static_cast<double>(report.contact.candidates);
    state.counters["assembly_ms"] = 1e3 * report.assembly_seconds;
    state.counters["solve_ms"] = 1e3 * report.solve_seconds;
    state.counters["contact_ms"] = 1e3 * report.contact.seconds;
    state.counters["contact_share"] = contact_seconds / seconds;
    state.counters["MB"] = 1e-6 * static_cast<double>(simulation.size().bytes);
}

void hug(benchmark::State& state) {
    run_steps(state, hug_scene(false), {hug_body(1), hug_body(2)}, 2);
}
BENCHMARK(hug)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

void hug_self(benchmark::State& state) {
    run_steps(state, hug_scene(true), {hug_body(1), hug_body(2)}, 2);
}
BENCHMARK(hug_self)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

void hug_newton(benchmark::State& state) {
    Scene scene = hug_scene(false);
    scene.solver.integrator = Integrator::NewtonEuler;
    run_steps(state, scene, {hug_body(1), hug_body(2)}, 2);
}
BENCHMARK(hug_newton)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

// A beam of 50 x 6 x 6 x 6 cells, 259,200 pentachora, held at one end under gravity, without contact
// and where it may meet itself.
void beam(benchmark::State& state, bool self) {
    Scene scene = one_body();
    scene.gravity[1] = -9.8;
    const HalfSpaceSelection end{.normal = Eigen::Vector4d(1, 0, 0, 0), .offset = 1e-6};
    scene.constraints = {{.body = "body", .select = {end}, .motion = {}}};
    scene.contact->self = self;
    run_steps(state, scene, {box({50, 6, 6, 6})}, 8);
}
BENCHMARK_CAPTURE(beam, alone, false)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(beam, self, true)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace pent::simulator
