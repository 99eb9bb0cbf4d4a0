// Writing, reading and validating a mesh of 300k pentachora, and finding its boundary.
// Targets: written in under 50 ms, read and validated in under 150 ms.

#include "support/kuhn_box.h"

#include <pent/facets.h>
#include <pent/pent_file.h>

#include <benchmark/benchmark.h>

#include <filesystem>

namespace pent {
namespace {

// 302,400 pentachora.
SimplexMesh<4> box() {
    SimplexMesh<4> mesh = test::kuhn_box<4>({14, 10, 10, 9}, {1.4, 1, 1, 0.9});
    mesh.columns.assign(mesh.vertex_count(), 1);
    mesh.layers.assign(mesh.vertex_count(), 1);
    mesh.regions.assign(mesh.cell_count(), 0);
    return mesh;
}

void count(benchmark::State& state, const SimplexMesh<4>& mesh) {
    state.SetItemsProcessed(state.iterations() * mesh.cell_count());
    state.counters["pentachora"] = static_cast<double>(mesh.cell_count());
}

std::filesystem::path sample_file() {
    return std::filesystem::temp_directory_path() / "pent-bench.pent";
}

void write(benchmark::State& state, Encoding encoding) {
    const SimplexMesh<4> mesh = box();
    for (auto _ : state) {
        write_mesh(sample_file(), mesh, {.encoding = encoding});
    }
    count(state, mesh);
    state.counters["file_MB"] =
        static_cast<double>(std::filesystem::file_size(sample_file())) / 1e6;
    std::filesystem::remove(sample_file());
}

void read(benchmark::State& state, Encoding encoding) {
    const SimplexMesh<4> mesh = box();
    write_mesh(sample_file(), mesh, {.encoding = encoding});
    for (auto _ : state) {
        benchmark::DoNotOptimize(read_mesh<4>(sample_file()));
    }
    count(state, mesh);
    std::filesystem::remove(sample_file());
}

void BM_Validate(benchmark::State& state) {
    const SimplexMesh<4> mesh = box();
    for (auto _ : state) {
        validate(mesh, "box");
    }
    count(state, mesh);
}

void BM_MatchFacets(benchmark::State& state) {
    const SimplexMesh<4> mesh = box();
    for (auto _ : state) {
        benchmark::DoNotOptimize(match_facets<4>(mesh.cells, mesh.vertex_count()));
    }
    count(state, mesh);
}

BENCHMARK_CAPTURE(write, binary, Encoding::Binary)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read, binary, Encoding::Binary)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(write, ascii, Encoding::Ascii)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(read, ascii, Encoding::Ascii)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_Validate)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_MatchFacets)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pent

BENCHMARK_MAIN();
