#pragma once

#include <cstddef>
#include <cstdint>

// The measured loops, compiled once for each instruction set as the kernels are. No code is shared
// between the copies: all of it is in an unnamed namespace.

namespace pent::simulator::bench {

struct CeilingLoops {
    /// a = b + 3 c.
    void (*triad)(double* a, const double* b, const double* c, std::size_t count);
    /// Fused multiply-adds in independent chains; returns how many numbers were computed.
    std::int64_t (*float_chains)(std::int64_t rounds, float* result);
    std::int64_t (*double_chains)(std::int64_t rounds, double* result);
};

[[nodiscard]] CeilingLoops ceiling_loops_baseline();
[[nodiscard]] CeilingLoops ceiling_loops_avx2();
[[nodiscard]] CeilingLoops ceiling_loops_avx512();

namespace {  // NOLINT(google-build-namespaces)

inline void triad_loop(double* __restrict a,
                       const double* __restrict b,
                       const double* __restrict c,
                       std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        a[i] = b[i] + 3 * c[i];
    }
}

// As many chains as hide the latency of an operation on current processors.
template <typename Scalar, int Bytes>
std::int64_t chains(std::int64_t rounds, Scalar* result) {
    using Vector [[gnu::vector_size(Bytes)]] = Scalar;
    constexpr int kChains = 12;
    constexpr int kLanes = Bytes / static_cast<int>(sizeof(Scalar));
    Vector sums[kChains];
    for (int i = 0; i < kChains; ++i) {
        sums[i] = Vector{} + Scalar(i);  // alike, a compiler would keep one of them
    }
    const Vector factor = Vector{} + Scalar(0.999);
    const Vector term = Vector{} + Scalar(0.001);
    for (std::int64_t round = 0; round < rounds; ++round) {
        for (Vector& sum : sums) {
            sum = sum * factor + term;
        }
    }
    for (const Vector& sum : sums) {
        for (int lane = 0; lane < kLanes; ++lane) {
            *result += sum[lane];
        }
    }
    return rounds * kChains * kLanes;
}

}  // namespace
}  // namespace pent::simulator::bench
