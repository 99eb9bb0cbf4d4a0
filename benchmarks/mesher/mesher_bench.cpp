// Speed of the mesher. What counts is the ratio to the memory's speed, or to TetGen's, in the same
// run: absolute times hold for one machine only. The ratios, and what is aimed at, come last.

#include "generators.h"
#include "worker_process.h"

#include <pent/mesher/make_body.h>
#include <pent/mesher/orient.h>
#include <pent/mesher/prove.h>
#include <pent/mesher/quality.h>
#include <pent/mesher/shapes.h>
#include <pent/mesher/straight_layers.h>
#include <pent/parallel.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <sys/resource.h>
#include <thread>
#include <vector>

namespace {

using pent::SimplexMesh;

constexpr int kSlabs = 7;

// 384,000 tetrahedra; in 7 slabs 10,752,000 pentachora.
const SimplexMesh<3>& large_base() {
    static const SimplexMesh<3> mesh = pent::mesher::box<3>({40, 40, 40}, {1, 1, 1});
    return mesh;
}

const pent::OrderedCells<3>& large_order() {
    static const auto ordered = pent::mesher::order_cells<3>(
        large_base(), pent::mesher::direct_edges<3>(
                          large_base(), pent::mesher::rank_vertices<3>(
                                            large_base(), pent::mesher::VertexOrder::Index)));
    return ordered;
}

SimplexMesh<4> large_body() {
    return pent::extrude<4>(
        large_base(), large_order(),
        pent::mesher::straight_layers<4>(Eigen::Vector4d(0, 0, 0, 0.2), kSlabs));
}

// What an extrusion writes: positions, columns and layers of vertices, and cells.
std::int64_t bytes_of(const SimplexMesh<4>& mesh) {
    return mesh.vertex_count() * (4 * 8 + 4 + 4) + mesh.cell_count() * 5 * 4;
}

void memory_write(benchmark::State& state) {
    const std::int64_t bytes = bytes_of(large_body());
    for (auto _ : state) {
        // Fresh memory each time, as a new mesh has.
        const std::unique_ptr<char[]> memory(new char[static_cast<std::size_t>(bytes)]);
        std::memset(memory.get(), 1, static_cast<std::size_t>(bytes));
        benchmark::DoNotOptimize(memory.get());
    }
    state.SetBytesProcessed(state.iterations() * bytes);
}
BENCHMARK(memory_write)->Unit(benchmark::kMillisecond)->UseRealTime();

void extrude_10m(benchmark::State& state) {
    std::int64_t bytes = 0;
    std::int64_t cells = 0;
    static_cast<void>(large_order());
    for (auto _ : state) {
        const SimplexMesh<4> mesh = large_body();
        benchmark::DoNotOptimize(mesh.cells.data());
        bytes = bytes_of(mesh);
        cells = mesh.cell_count();
    }
    state.SetBytesProcessed(state.iterations() * bytes);
    state.SetItemsProcessed(state.iterations() * cells);
}
BENCHMARK(extrude_10m)->Unit(benchmark::kMillisecond)->UseRealTime();

void order_384k(benchmark::State& state) {
    for (auto _ : state) {
        const auto ordered = pent::mesher::order_cells<3>(
            large_base(), pent::mesher::direct_edges<3>(
                              large_base(), pent::mesher::rank_vertices<3>(
                                                large_base(), pent::mesher::VertexOrder::Index)));
        benchmark::DoNotOptimize(ordered.cells.data());
    }
}
BENCHMARK(order_384k)->Unit(benchmark::kMillisecond)->Iterations(3);

void prove_10m(benchmark::State& state) {
    const SimplexMesh<4> mesh = large_body();
    for (auto _ : state) {
        const pent::mesher::Proof proof = pent::mesher::prove(mesh, 0.2);
        if (!proof.holds()) {
            state.SkipWithError("the proof does not hold");
        }
    }
    state.SetItemsProcessed(state.iterations() * mesh.cell_count());
}
BENCHMARK(prove_10m)->Unit(benchmark::kMillisecond)->Iterations(2)->UseRealTime();

void measure_quality_10m(benchmark::State& state) {
    const SimplexMesh<4> mesh = large_body();
    for (auto _ : state) {
        const pent::mesher::QualityReport report = pent::mesher::measure_quality(mesh);
        benchmark::DoNotOptimize(report.mean_ratio.min);
    }
    state.SetItemsProcessed(state.iterations() * mesh.cell_count());
}
BENCHMARK(measure_quality_10m)->Unit(benchmark::kMillisecond)->Iterations(1);

std::string octopus() {
    return std::string(PENT_MODELS) + "/octopus_5246f.obj";
}

// Its process, without any check of what it gives.
void tetgen_alone(benchmark::State& state) {
    const pent::mesher::Surface surface =
        pent::mesher::orient(pent::mesher::read_surface(octopus()).surface).surface;
    for (auto _ : state) {
        const pent::mesher::Tetrahedra tetrahedra =
            pent::mesher::fill_with_tetgen(surface, pent::mesher::TetrahedraOptions());
        benchmark::DoNotOptimize(tetrahedra.mesh.cells.data());
    }
}
BENCHMARK(tetgen_alone)->Unit(benchmark::kMillisecond)->UseRealTime();

// From the file to 304,096 proven pentachora.
void body_of_300k(benchmark::State& state) {
    pent::mesher::BodyRequest request;
    request.input = std::filesystem::path(octopus());
    double fill = 0;
    double rest = 0;
    for (auto _ : state) {
        const pent::mesher::Body<4> body = pent::mesher::make_body(request);
        benchmark::DoNotOptimize(body.mesh.cells.data());
        for (const pent::mesher::Stage& stage : body.report.stages) {
            (stage.name == "fill" ? fill : rest) += 1000 * stage.seconds;
        }
    }
    state.counters["fill_ms"] = benchmark::Counter(fill, benchmark::Counter::kAvgIterations);
    state.counters["rest_ms"] = benchmark::Counter(rest, benchmark::Counter::kAvgIterations);
}
BENCHMARK(body_of_300k)->Unit(benchmark::kMillisecond)->UseRealTime();

// Peak memory of the whole program for the same body, bytes. To be asked before this process has
// used much itself: a new process is counted from what the one that started it had.
double peak_memory_of_300k() {
    const auto output = std::filesystem::temp_directory_path() / "pent_mesher_bench.pent";
    const pent::File nothing = pent::temporary_file();
    const pent::mesher::ProcessResult result = pent::mesher::run_process(
        PENT_MESH, {octopus(), "-o", output.string(), "--quiet"}, nothing.get(), nothing.get());
    std::filesystem::remove(output);
    rusage usage{};
    ::getrusage(RUSAGE_CHILDREN, &usage);
    const bool is_done = result.signal == 0 && result.exit_code == 0;
    return is_done ? 1024.0 * static_cast<double>(usage.ru_maxrss) : std::nan("");
}

// Prints the usual lines, and keeps them for the ratios.
class Collector : public benchmark::ConsoleReporter {
public:
    void ReportRuns(const std::vector<Run>& runs) override {
        ConsoleReporter::ReportRuns(runs);
        for (const Run& run : runs) {
            const std::string name = run.run_name.function_name;
            milliseconds_[name] = run.GetAdjustedRealTime();
            for (const auto& [counter, value] : run.counters) {
                milliseconds_[counter] = value;
            }
        }
    }

    /// NaN for what did not run.
    [[nodiscard]] double milliseconds(const std::string& name) const {
        const auto place = milliseconds_.find(name);
        return place == milliseconds_.end() ? std::nan("") : place->second;
    }

private:
    std::map<std::string, double> milliseconds_;
};

void print_ratios(const Collector& times, double peak_bytes) {
    constexpr double kCells = 304'096;
    std::printf("\n%-52s %8s  aim\n", "ratio", "found");
    const auto line = [](const char* name, double found, const char* aim) {
        std::printf("%-52s %8.3g  %s\n", name, found, aim);
    };
    line("extrusion's bandwidth over that of writing memory",
         times.milliseconds("memory_write") / times.milliseconds("extrude_10m"), ">= 0.4");
    line("proof over extrusion",
         times.milliseconds("prove_10m") / times.milliseconds("extrude_10m"), "<= 15");
    line("filling, with its checks, over TetGen alone",
         times.milliseconds("fill_ms") / times.milliseconds("tetgen_alone"), "<= 3");
    line("all else for 304,096 pentachora, s", times.milliseconds("rest_ms") / 1000, "<= 0.5");
    line("peak memory of pent-mesh, bytes a pentachoron", peak_bytes / kCells, "<= 200");
}

}  // namespace

int main(int argc, char** argv) {
    const double peak_bytes = peak_memory_of_300k();
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
        return 1;
    }
    Collector times;
    const auto cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    pent::Workers(cores).run([&] { benchmark::RunSpecifiedBenchmarks(&times); });
    print_ratios(times, peak_bytes);
    return 0;
}
