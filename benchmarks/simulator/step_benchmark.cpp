// Whole steps of the beam, state after the eighth; counters: iterations, memory, hash of the state.

#include "beams.h"

#include <pent/simulator/simulation.h>

#include <benchmark/benchmark.h>

#include <bit>

namespace pent::simulator {
namespace {

// FNV-1a over the bits of all coordinates: a faster wrong answer has another one.
double state_hash(const Simulation<4>& simulation) {
    std::uint32_t hash = 2166136261U;
    for (const double x : simulation.positions(0).reshaped()) {
        const auto bits = std::bit_cast<std::uint64_t>(x);
        for (int byte = 0; byte < 8; ++byte) {
            hash = (hash ^ static_cast<std::uint32_t>(bits >> (8 * byte) & 0xff)) * 16777619U;
        }
    }
    return hash;
}

void run_steps(benchmark::State& state, const Scene& scene, const SimplexMesh<4>& mesh) {
    constexpr int kWarmUp = 8;
    Simulation<4> simulation(scene, {mesh}, {.threads = static_cast<int>(state.range(0))});
    for (int i = 0; i < kWarmUp; ++i) {
        benchmark::DoNotOptimize(simulation.step().is_accepted);
    }
    const Positions<4> positions = simulation.positions(0);
    const Positions<4> velocities = simulation.velocities(0);
    StepReport report;
    for ([[maybe_unused]] auto _ : state) {
        state.PauseTiming();
        simulation.set_state(0, positions, velocities);
        simulation.set_step_count(kWarmUp);
        benchmark::DoNotOptimize(simulation.energies());
        state.ResumeTiming();
        report = simulation.step();
    }
    state.counters["iterations"] = report.iterations;
    state.counters["newton"] = report.newton_iterations;
    state.counters["assembly_ms"] = 1e3 * report.assembly_seconds;
    state.counters["solve_ms"] = 1e3 * report.solve_seconds;
    state.counters["MB"] = 1e-6 * static_cast<double>(simulation.size().bytes);
    state.counters["hash"] = state_hash(simulation);
}

void beam_linear(benchmark::State& state) {
    run_steps(state, bench::beam_scene(), bench::beam());
}
BENCHMARK(beam_linear)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

void beam_newton(benchmark::State& state) {
    Scene scene = bench::beam_scene();
    scene.solver.integrator = Integrator::NewtonEuler;
    run_steps(state, scene, bench::beam());
}
BENCHMARK(beam_newton)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

// Layers as thin as the argument, in hundredths of the other edges.
void beam_aspect(benchmark::State& state) {
    run_steps(state, bench::beam_scene(),
              bench::beam(0.1 * static_cast<double>(state.range(1)) / 100));
}
BENCHMARK(beam_aspect)
    ->ArgsProduct({{2}, {100, 50, 20, 10}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void beam_stiff_poisson(benchmark::State& state) {
    run_steps(state, bench::beam_scene(0.32), bench::beam());
}
BENCHMARK(beam_stiff_poisson)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

// 4,096 to 16 times as many cubes: growth of time with size.
void compact_box(benchmark::State& state) {
    const int n = static_cast<int>(state.range(1));
    run_steps(state, bench::beam_scene(), bench::box({n, n, n, n}));
}
BENCHMARK(compact_box)
    ->ArgsProduct({{2}, {8, 11, 16}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace pent::simulator
