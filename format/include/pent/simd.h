#pragma once

#include <pent/mask.h>
#include <pent/pack.h>

#include <cstddef>
#include <utility>

namespace pent {

/// a * b + c, lane by lane: rounded once where this file is compiled for fused multiply-add, else
/// twice.
template <typename Number, int Count>
PENT_SIMD_INLINE Pack<Number, Count> multiply_add(const Pack<Number, Count>& a,
                                                  const Pack<Number, Count>& b,
                                                  const Pack<Number, Count>& c) {
    using Vector = typename Pack<Number, Count>::Vector;
    [[maybe_unused]] constexpr bool kIsFloat = sizeof(Number) == sizeof(float);
    [[maybe_unused]] constexpr int kBytes = static_cast<int>(sizeof(Vector));
#if defined(__AVX512F__)
    if constexpr (kBytes == 64 && kIsFloat) {
        return Pack<Number, Count>(reinterpret_cast<Vector>(
            _mm512_fmadd_ps(reinterpret_cast<__m512>(a.lanes), reinterpret_cast<__m512>(b.lanes),
                            reinterpret_cast<__m512>(c.lanes))));
    } else if constexpr (kBytes == 64) {
        return Pack<Number, Count>(reinterpret_cast<Vector>(
            _mm512_fmadd_pd(reinterpret_cast<__m512d>(a.lanes), reinterpret_cast<__m512d>(b.lanes),
                            reinterpret_cast<__m512d>(c.lanes))));
    }
#endif
#if defined(__FMA__)
    if constexpr (kBytes == 32 && kIsFloat) {
        return Pack<Number, Count>(reinterpret_cast<Vector>(
            _mm256_fmadd_ps(reinterpret_cast<__m256>(a.lanes), reinterpret_cast<__m256>(b.lanes),
                            reinterpret_cast<__m256>(c.lanes))));
    } else if constexpr (kBytes == 32) {
        return Pack<Number, Count>(reinterpret_cast<Vector>(
            _mm256_fmadd_pd(reinterpret_cast<__m256d>(a.lanes), reinterpret_cast<__m256d>(b.lanes),
                            reinterpret_cast<__m256d>(c.lanes))));
    }
    Pack<Number, Count> sum = c;
    for (int i = 0; i < Count; ++i) {
        if constexpr (kIsFloat) {
            sum.lanes[i] = __builtin_fmaf(a.lanes[i], b.lanes[i], c.lanes[i]);
        } else {
            sum.lanes[i] = __builtin_fma(a.lanes[i], b.lanes[i], c.lanes[i]);
        }
    }
    return sum;
#else
    return a * b + c;
#endif
}

/// The square root, correctly rounded; NaN below zero.
template <typename Number, int Count>
PENT_SIMD_INLINE Pack<Number, Count> sqrt(const Pack<Number, Count>& a) {
    using Vector = typename Pack<Number, Count>::Vector;
    [[maybe_unused]] constexpr bool kIsFloat = sizeof(Number) == sizeof(float);
    [[maybe_unused]] constexpr int kBytes = static_cast<int>(sizeof(Vector));
#if defined(__AVX512F__)
    if constexpr (kBytes == 64 && kIsFloat) {
        return Pack<Number, Count>(reinterpret_cast<Vector>(
            _mm512_maskz_sqrt_ps(0xffff, reinterpret_cast<__m512>(a.lanes))));
    } else if constexpr (kBytes == 64) {
        return Pack<Number, Count>(reinterpret_cast<Vector>(
            _mm512_maskz_sqrt_pd(0xff, reinterpret_cast<__m512d>(a.lanes))));
    }
#endif
#if defined(__AVX__)
    if constexpr (kBytes == 32 && kIsFloat) {
        return Pack<Number, Count>(
            reinterpret_cast<Vector>(_mm256_sqrt_ps(reinterpret_cast<__m256>(a.lanes))));
    } else if constexpr (kBytes == 32) {
        return Pack<Number, Count>(
            reinterpret_cast<Vector>(_mm256_sqrt_pd(reinterpret_cast<__m256d>(a.lanes))));
    }
#endif
#if defined(__SSE2__)
    if constexpr (kBytes == 16 && kIsFloat) {
        return Pack<Number, Count>(
            reinterpret_cast<Vector>(_mm_sqrt_ps(reinterpret_cast<__m128>(a.lanes))));
    } else if constexpr (kBytes == 16) {
        return Pack<Number, Count>(
            reinterpret_cast<Vector>(_mm_sqrt_pd(reinterpret_cast<__m128d>(a.lanes))));
    }
#elif defined(__aarch64__)
    if constexpr (kBytes == 16 && kIsFloat) {
        return Pack<Number, Count>(
            reinterpret_cast<Vector>(vsqrtq_f32(reinterpret_cast<float32x4_t>(a.lanes))));
    } else if constexpr (kBytes == 16) {
        return Pack<Number, Count>(
            reinterpret_cast<Vector>(vsqrtq_f64(reinterpret_cast<float64x2_t>(a.lanes))));
    }
#elif defined(__wasm_simd128__)
    if constexpr (kBytes == 16 && kIsFloat) {
        return Pack<Number, Count>(
            reinterpret_cast<Vector>(wasm_f32x4_sqrt(reinterpret_cast<v128_t>(a.lanes))));
    } else if constexpr (kBytes == 16) {
        return Pack<Number, Count>(
            reinterpret_cast<Vector>(wasm_f64x2_sqrt(reinterpret_cast<v128_t>(a.lanes))));
    }
#endif
    Pack<Number, Count> root = a;
    for (int i = 0; i < Count; ++i) {
        if constexpr (kIsFloat) {
            root.lanes[i] = __builtin_sqrtf(a.lanes[i]);
        } else {
            root.lanes[i] = __builtin_sqrt(a.lanes[i]);
        }
    }
    return root;
}

namespace detail {

// One butterfly of a transposition: where a lane has the bit Step it takes from `high`.
template <int Step, typename Vector, std::size_t... Lane>
[[gnu::always_inline]] inline void exchange(Vector& low,
                                            Vector& high,
                                            std::index_sequence<Lane...> /*lanes*/) {
    constexpr auto kCount = sizeof...(Lane);
    const Vector first = low;
    low = __builtin_shufflevector(
        first, high, static_cast<int>((Lane & Step) != 0 ? kCount + Lane - Step : Lane)...);
    high = __builtin_shufflevector(
        first, high, static_cast<int>((Lane & Step) != 0 ? kCount + Lane : Lane + Step)...);
}

template <typename Row>
[[gnu::always_inline]] inline auto& lanes_of(Row& row) {
    if constexpr (requires { row.lanes; }) {
        return row.lanes;
    } else {
        return row;
    }
}

}  // namespace detail

/// Transposes `Count` packs, or vectors of the compiler, of as many lanes each: rows become
/// columns.
template <int Count, typename Row, int Step = Count / 2>
[[gnu::always_inline]] inline void transpose(Row* rows) {
    if constexpr (Step > 0) {
        for (int i = 0; i < Count; ++i) {
            if ((i & Step) == 0) {
                detail::exchange<Step>(detail::lanes_of(rows[i]), detail::lanes_of(rows[i + Step]),
                                       std::make_index_sequence<Count>());
            }
        }
        transpose<Count, Row, Step / 2>(rows);
    }
}

}  // namespace pent
