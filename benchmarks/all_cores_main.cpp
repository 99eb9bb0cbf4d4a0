#include <pent/parallel.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <thread>

// Runs the benchmarks of a library with a worker for each core.
int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
        return 1;
    }
    const auto cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    pent::Workers(cores).run([] { benchmark::RunSpecifiedBenchmarks(); });
    return 0;
}
