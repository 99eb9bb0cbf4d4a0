// What the machine can do, measured in the same run as the kernels: memory and arithmetic.

#include <benchmark/benchmark.h>

#include <vector>

namespace {

// a = b + s c: 24 bytes an element, the write counted once.
void triad(benchmark::State& state) {
    const std::size_t n = 8'000'000;
    std::vector<double> a(n, 0);
    const std::vector<double> b(n, 1);
    const std::vector<double> c(n, 2);
    for ([[maybe_unused]] auto _ : state) {
        for (std::size_t i = 0; i < n; ++i) {
            a[i] = b[i] + 3 * c[i];
        }
        benchmark::DoNotOptimize(a.data());
        benchmark::ClobberMemory();
    }
    state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * n * 24));
}
BENCHMARK(triad)->Unit(benchmark::kMillisecond);

}  // namespace
