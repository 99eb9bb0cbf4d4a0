#include "ceilings.h"

#include "ceilings_isa.h"

#include <pent/stopwatch.h>

#include <algorithm>
#include <vector>

namespace pent::simulator::bench {

namespace {

CeilingLoops loops() {
#ifdef PENT_X86_KERNELS
    switch (best_isa()) {
        case Isa::Avx512:
            return ceiling_loops_avx512();
        case Isa::Avx2:
            return ceiling_loops_avx2();
        default:
            break;
    }
#endif
    return ceiling_loops_baseline();
}

// Bytes a second over three arrays of `count` numbers, a written one counted once; as many
// repetitions go before those that count, so that what a cache can hold is there.
double triad(const Workers& workers, std::size_t count, int repetitions) {
    constexpr std::size_t kChunk = 1 << 15;
    static std::vector<double> a;
    static std::vector<double> b;
    static std::vector<double> c;
    if (a.size() < count) {
        a.resize(count, 0);
        b.resize(count, 1);
        c.resize(count, 2);
    }
    const CeilingLoops loop = loops();
    const auto seconds = [&] {
        const Stopwatch watch;
        for (int i = 0; i < repetitions; ++i) {
            workers.for_each(static_cast<int>(count / kChunk), [&](int chunk) {
                const std::size_t at = static_cast<std::size_t>(chunk) * kChunk;
                loop.triad(a.data() + at, b.data() + at, c.data() + at, kChunk);
            });
        }
        return watch.seconds();
    };
    static_cast<void>(seconds());
    const std::size_t whole_chunks = count / kChunk * kChunk;
    return 24 * static_cast<double>(whole_chunks) * repetitions / seconds();
}

template <typename Scalar, typename Chains>
double flops(const Workers& workers, Chains chains) {
    constexpr std::int64_t kRounds = 1'000'000;
    std::vector<Scalar> results(static_cast<std::size_t>(workers.threads()));
    std::vector<std::int64_t> done(results.size());
    const Stopwatch watch;
    workers.for_each(workers.threads(), [&](int thread) {
        const auto t = static_cast<std::size_t>(thread);
        done[t] = chains(kRounds, &results[t]);
    });
    const double seconds = watch.seconds();
    return 2 * static_cast<double>(done[0]) * workers.threads() / seconds;
}

}  // namespace

Ceilings measure_ceilings(const Workers& workers) {
    return {.memory = triad(workers, 8 << 20, 1),
            .cache = triad(workers, 21 << 15, 16),
            .float_flops = flops<float>(workers, loops().float_chains),
            .double_flops = flops<double>(workers, loops().double_chains)};
}

Work& Work::operator+=(const Work& other) {
    float_flops += other.float_flops;
    double_flops += other.double_flops;
    bytes += other.bytes;
    return *this;
}

double least_seconds(const Work& work, const Ceilings& ceilings) {
    constexpr double kCacheBytes = 24e6;
    const double speed =
        work.bytes < kCacheBytes ? std::max(ceilings.cache, ceilings.memory) : ceilings.memory;
    return std::max(
        work.float_flops / ceilings.float_flops + work.double_flops / ceilings.double_flops,
        work.bytes / speed);
}

}  // namespace pent::simulator::bench
