// One thread, the beam, each instruction set: ns per element or per block is time / items.

#include "beams.h"
#include "conjugate_gradients.h"
#include "elements.h"
#include "preconditioner.h"

#include <benchmark/benchmark.h>

#include <memory>
#include <numeric>
#include <random>

namespace pent::simulator {
namespace {

struct BeamSystem {
    SimplexMesh<4> mesh = bench::beam();
    Numbering numbering;
    BlockPattern pattern;
    std::unique_ptr<Elements<4>> elements;
    Positions<4> positions;

    BeamSystem() {
        numbering = number_unknowns<4>(mesh.cells, std::vector<bool>(mesh.columns.size(), false),
                                       mesh.columns, mesh.layers);
        pattern = make_pattern<4>(mesh.cells, numbering);
        const Material material{.lame = lame_from_young(4, 1e7, 0.28)};
        const std::vector<CellRange> ranges = {{0, mesh.cell_count(), material}};
        elements =
            std::make_unique<Elements<4>>(mesh.positions, mesh.cells, ranges, numbering, pattern);
        std::mt19937 random(1);
        std::normal_distribution<double> normal(0, 0.01);  // a tenth of an edge
        positions = mesh.positions.unaryExpr([&](double x) { return x + normal(random); });
    }
};

const BeamSystem& beam() {
    static const BeamSystem system;
    return system;
}

bool skip_unsupported(benchmark::State& state, Isa isa) {
    state.SetLabel(std::string(isa_name(isa)));
    if (!is_supported(isa)) {
        state.SkipWithError("not supported by this machine");
    }
    return !is_supported(isa);
}

void forces(benchmark::State& state) {
    const Isa isa = static_cast<Isa>(state.range(0));
    if (skip_unsupported(state, isa)) {
        return;
    }
    Positions<4> out = Positions<4>::Zero(4, beam().mesh.vertex_count());
    for ([[maybe_unused]] auto _ : state) {
        benchmark::DoNotOptimize(
            beam().elements->add_forces(Workers(1), kernels<4>(isa), beam().positions, out));
    }
    state.SetItemsProcessed(state.iterations() * beam().elements->count());
}
BENCHMARK(forces)->DenseRange(0, 3)->Unit(benchmark::kMillisecond);

template <typename Scalar>
void hessian(benchmark::State& state) {
    const Isa isa = static_cast<Isa>(state.range(0));
    if (skip_unsupported(state, isa)) {
        return;
    }
    const Positions<4> still = Positions<4>::Zero(4, beam().mesh.vertex_count());
    BlockMatrix<4, Scalar> matrix(beam().pattern);
    BlockVector<4> right = BlockVector<4>::Zero(4, beam().pattern.rows());
    const Workers workers(static_cast<int>(state.range(1)));
    for ([[maybe_unused]] auto _ : state) {
        matrix.set_zero(workers);
        beam().elements->add_hessian(workers, kernels<4>(isa), beam().positions, 1e-3,
                                     Filter::Clamp, still, matrix, right);
    }
    state.SetItemsProcessed(state.iterations() * beam().elements->count());
}
BENCHMARK(hessian<float>)
    ->ArgsProduct({{0, 1, 2, 3}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(hessian<double>)
    ->ArgsProduct({{0, 3}, {1}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

template <typename Scalar>
void multiply(benchmark::State& state) {
    const Isa isa = static_cast<Isa>(state.range(0));
    if (skip_unsupported(state, isa)) {
        return;
    }
    const Workers workers(static_cast<int>(state.range(1)));
    const BlockMatrix<4, Scalar> matrix(beam().pattern);
    const BlockVector<4> x = BlockVector<4>::Ones(4, matrix.rows());
    BlockVector<4> y(4, matrix.rows());
    for ([[maybe_unused]] auto _ : state) {
        matrix.multiply(workers, kernels<4>(isa), x, y);
    }
    state.SetItemsProcessed(state.iterations() * beam().pattern.blocks());
    state.SetBytesProcessed(state.iterations() * beam().pattern.blocks()
                            * static_cast<std::int64_t>(16 * sizeof(Scalar) + 4));
}
BENCHMARK(multiply<float>)
    ->ArgsProduct({{0, 1, 2, 3}, {1, 2}})
    ->Unit(benchmark::kMicrosecond)
    ->UseRealTime();
BENCHMARK(multiply<double>)
    ->ArgsProduct({{3}, {1, 2}})
    ->Unit(benchmark::kMicrosecond)
    ->UseRealTime();

void precondition(benchmark::State& state) {
    const Workers workers(static_cast<int>(state.range(0)));
    BlockMatrix<4, float> matrix(beam().pattern);
    const Positions<4> still = Positions<4>::Zero(4, beam().mesh.vertex_count());
    BlockVector<4> right = BlockVector<4>::Zero(4, beam().pattern.rows());
    beam().elements->add_hessian(workers, kernels<4>(best_isa()), beam().positions, 1e-3,
                                 Filter::Clamp, still, matrix, right);
    for (std::int64_t row = 0; row < matrix.rows(); ++row) {
        matrix.diagonal(row).diagonal().array() += 1;
    }
    const std::vector<std::uint32_t> bodies(static_cast<std::size_t>(matrix.rows()), 0);
    const Aggregates aggregates = make_aggregates<4>(beam().positions, bodies);
    const auto make = [&] {
        return with_rigid_modes(workers, matrix, aggregates, beam().positions,
                                column_jacobi(workers, matrix, beam().numbering.column_start));
    };
    const bool is_setup = state.range(1) == 1;
    state.SetLabel(is_setup ? "set-up" : "apply");
    const auto ready = make();
    BlockVector<4> z(4, matrix.rows());
    for ([[maybe_unused]] auto _ : state) {
        if (is_setup) {
            benchmark::DoNotOptimize(make());
        } else {
            ready->apply(workers, right, z);
        }
    }
}
BENCHMARK(precondition)
    ->ArgsProduct({{1, 2}, {0, 1}})
    ->Unit(benchmark::kMicrosecond)
    ->UseRealTime();

}  // namespace
}  // namespace pent::simulator
