// Steps of scenes where contact is all there is; counters: iterations, pairs, and the share of
// contact in the time of a step.

#include "step_scenes.h"

#include <pent/simulator/simulation.h>

#include <benchmark/benchmark.h>

namespace pent::simulator {
namespace {

using namespace bench;

// Positions and velocities of all bodies.
struct Start {
    std::vector<Positions<4>> positions;
    std::vector<Positions<4>> velocities;
};

void set(Simulation<4>& simulation, const Start& start) {
    for (int body = 0; body < simulation.body_count(); ++body) {
        const auto i = static_cast<std::size_t>(body);
        simulation.set_state(body, start.positions[i], start.velocities[i]);
    }
}

// A scene after some linear steps; if it is to settle, each of them from a standstill.
Start after_steps(Scene scene,
                  const std::vector<SimplexMesh<4>>& meshes,
                  int steps,
                  bool does_settle) {
    scene.solver.integrator = Integrator::LinearEuler;
    Simulation<4> simulation(scene, meshes, {.threads = 2});
    Start start;
    for (int i = 0; i < steps; ++i) {
        benchmark::DoNotOptimize(simulation.step().is_accepted);
        start = {};
        for (int body = 0; body < simulation.body_count(); ++body) {
            start.positions.emplace_back(simulation.positions(body));
            start.velocities.emplace_back((does_settle ? 0 : 1) * simulation.velocities(body));
        }
        if (does_settle) {
            set(simulation, start);
        }
    }
    return start;
}

// The same step again and again.
void run_steps(benchmark::State& state,
               const Scene& scene,
               const std::vector<SimplexMesh<4>>& meshes,
               const Start& start) {
    Simulation<4> simulation(scene, meshes, {.threads = static_cast<int>(state.range(0))});
    StepReport report;
    double seconds = 0;
    double contact_seconds = 0;
    for ([[maybe_unused]] auto _ : state) {
        state.PauseTiming();
        set(simulation, start);
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

void hug_of(benchmark::State& state,
            const std::vector<SimplexMesh<4>>& meshes,
            bool self,
            Integrator integrator) {
    Scene scene = hug_scene(self);
    const Start start = after_steps(scene, meshes, 12, true);
    scene.solver.integrator = integrator;
    run_steps(state, scene, meshes, start);
}

void hug(benchmark::State& state, bool self, Integrator integrator) {
    hug_of(state, {hug_body(1), hug_body(2)}, self, integrator);
}
BENCHMARK_CAPTURE(hug, between, false, Integrator::LinearEuler)
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(hug, self, true, Integrator::LinearEuler)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(hug, newton, false, Integrator::NewtonEuler)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

// Two small bodies, 1,920 pentachora in all: what a step costs whatever there is to do.
void small(benchmark::State& state, bool self, Integrator integrator) {
    constexpr std::array<int, 4> kCells{5, 2, 2, 2};
    hug_of(state, {hug_body(1, kCells), hug_body(2, kCells)}, self, integrator);
}
BENCHMARK_CAPTURE(small, between, false, Integrator::LinearEuler)
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(small, self, true, Integrator::LinearEuler)
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(small, newton, true, Integrator::NewtonEuler)
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

// A beam of 50 x 6 x 6 x 6 cells, 259,200 pentachora, held at one end under gravity, without
// contact and where it may meet itself.
void beam(benchmark::State& state, bool self) {
    Scene scene = one_body();
    scene.gravity[1] = -9.8;
    const HalfSpaceSelection end{.normal = Eigen::Vector4d(1, 0, 0, 0), .offset = 1e-6};
    scene.constraints = {{.body = "body", .select = {end}, .motion = {}}};
    scene.contact->self = self;
    const std::vector<SimplexMesh<4>> meshes{box({50, 6, 6, 6})};
    run_steps(state, scene, meshes, after_steps(scene, meshes, 8, false));
}
BENCHMARK_CAPTURE(beam, alone, false)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(beam, self, true)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace pent::simulator
