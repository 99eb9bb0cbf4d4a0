// Speed of the mesher. What counts is the ratio to the memory's speed, or to TetGen's, in the same
// run: absolute times hold for one machine only.

#include <pent/mesher/extrude.h>
#include <pent/mesher/make_body.h>
#include <pent/mesher/orient.h>
#include <pent/mesher/prove.h>
#include <pent/mesher/quality.h>
#include <pent/mesher/shapes.h>

#include <benchmark/benchmark.h>

#include <cstring>
#include <memory>

namespace {

using pent::SimplexMesh;

constexpr int kSlabs = 7;

// 384,000 tetrahedra; in 7 slabs 10,752,000 pentachora.
const SimplexMesh<3>& large_base() {
    static const SimplexMesh<3> mesh = pent::mesher::box<3>({40, 40, 40}, {1, 1, 1});
    return mesh;
}

const pent::mesher::OrderedCells<3>& large_order() {
    static const auto ordered = pent::mesher::order_cells<3>(
        large_base(), pent::mesher::direct_edges<3>(
                          large_base(), pent::mesher::rank_vertices<3>(
                                            large_base(), pent::mesher::VertexOrder::Index)));
    return ordered;
}

SimplexMesh<4> large_body() {
    return pent::mesher::extrude<4>(
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
BENCHMARK(memory_write)->Unit(benchmark::kMillisecond);

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
BENCHMARK(extrude_10m)->Unit(benchmark::kMillisecond);

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
BENCHMARK(prove_10m)->Unit(benchmark::kMillisecond)->Iterations(2);

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

void tetgen_alone(benchmark::State& state) {
    const pent::mesher::Surface surface =
        pent::mesher::orient(pent::mesher::read_surface(octopus()).surface).surface;
    for (auto _ : state) {
        const pent::mesher::Tetrahedra tetrahedra = pent::mesher::tetrahedralize(surface);
        benchmark::DoNotOptimize(tetrahedra.mesh.cells.data());
    }
}
BENCHMARK(tetgen_alone)->Unit(benchmark::kMillisecond);

// From the file to 304,096 proven pentachora.
void body_of_300k(benchmark::State& state) {
    pent::mesher::BodyRequest request;
    request.input = std::filesystem::path(octopus());
    for (auto _ : state) {
        const pent::mesher::Body<4> body = pent::mesher::make_body(request);
        benchmark::DoNotOptimize(body.mesh.cells.data());
    }
}
BENCHMARK(body_of_300k)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
