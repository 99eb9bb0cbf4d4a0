#pragma once

#include <cstdint>

#if defined(__SSE2__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

/// Numbers side by side in the vector types of g++ and clang, which lower what a machine lacks.
///
/// Every function is inlined wherever it is called, at every level of optimization: files compiled
/// for different instruction sets never share a copy of one.
#define PENT_SIMD_INLINE [[nodiscard, gnu::always_inline]] inline

namespace pent {

namespace detail {

template <typename Number, int Count>
struct VectorOf {
    using Type [[gnu::vector_size(Count * sizeof(Number))]] = Number;
};

template <int Bytes>
struct IntegerOf {
    using Type = std::int32_t;
};
template <>
struct IntegerOf<8> {
    using Type = std::int64_t;
};

}  // namespace detail

/// Truth values of the lanes of a Pack<Number, Count>.
template <typename Number, int Count>
struct Mask {
    using Vector =
        typename detail::VectorOf<typename detail::IntegerOf<sizeof(Number)>::Type, Count>::Type;
    Vector lanes;  ///< -1 or 0.

    PENT_SIMD_INLINE friend Mask operator&&(const Mask& a, const Mask& b) {
        return {a.lanes & b.lanes};
    }
    PENT_SIMD_INLINE friend Mask operator||(const Mask& a, const Mask& b) {
        return {a.lanes | b.lanes};
    }
    PENT_SIMD_INLINE friend Mask operator!(const Mask& a) { return {~a.lanes}; }
};

/// Whether any lane is true.
template <typename Number, int Count>
PENT_SIMD_INLINE bool any(const Mask<Number, Count>& mask) {
    [[maybe_unused]] constexpr int kBytes = static_cast<int>(sizeof mask.lanes);
#if defined(__AVX512F__)
    if constexpr (kBytes == 64 && sizeof(Number) == 4) {
        const auto lanes = reinterpret_cast<__m512i>(mask.lanes);
        return _mm512_test_epi32_mask(lanes, lanes) != 0;
    } else if constexpr (kBytes == 64) {
        const auto lanes = reinterpret_cast<__m512i>(mask.lanes);
        return _mm512_test_epi64_mask(lanes, lanes) != 0;
    }
#endif
#if defined(__AVX__)
    if constexpr (kBytes == 32) {
        const auto lanes = reinterpret_cast<__m256i>(mask.lanes);
        return _mm256_testz_si256(lanes, lanes) == 0;
    }
#endif
#if defined(__SSE2__)
    if constexpr (kBytes == 16) {
        return _mm_movemask_ps(reinterpret_cast<__m128>(mask.lanes)) != 0;
    }
#elif defined(__wasm_simd128__)
    if constexpr (kBytes == 16) {
        return wasm_v128_any_true(reinterpret_cast<v128_t>(mask.lanes));
    }
#endif
    bool is_any = false;
    for (int i = 0; i < Count; ++i) {
        is_any |= mask.lanes[i] != 0;
    }
    return is_any;
}

/// Whether all lanes are true.
template <typename Number, int Count>
PENT_SIMD_INLINE bool all(const Mask<Number, Count>& mask) {
#if defined(__SSE2__)
    if constexpr (sizeof mask.lanes == 16) {
        const int bits = _mm_movemask_ps(reinterpret_cast<__m128>(mask.lanes));
        return bits == 15;
    }
#endif
    return !any(!mask);
}

/// Bit i is whether lane i is true, of at most 32 lanes.
template <typename Number, int Count>
PENT_SIMD_INLINE std::uint32_t bits(const Mask<Number, Count>& mask) {
    static_assert(Count <= 32);
    [[maybe_unused]] constexpr int kBytes = static_cast<int>(sizeof mask.lanes);
#if defined(__AVX512F__)
    if constexpr (kBytes == 64 && sizeof(Number) == 4) {
        const auto lanes = reinterpret_cast<__m512i>(mask.lanes);
        return _mm512_test_epi32_mask(lanes, lanes);
    }
#endif
#if defined(__AVX__)
    if constexpr (kBytes == 32 && sizeof(Number) == 4) {
        return static_cast<std::uint32_t>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask.lanes)));
    }
#endif
#if defined(__SSE2__)
    if constexpr (kBytes == 16 && sizeof(Number) == 4) {
        return static_cast<std::uint32_t>(_mm_movemask_ps(reinterpret_cast<__m128>(mask.lanes)));
    }
#elif defined(__wasm_simd128__)
    if constexpr (kBytes == 16 && sizeof(Number) == 4) {
        return wasm_i32x4_bitmask(reinterpret_cast<v128_t>(mask.lanes));
    }
#endif
    // Copied: the undefined-behavior sanitizer of g++ 12 mistakes the index of a vector here.
    using Lane = typename detail::IntegerOf<sizeof(Number)>::Type;
    Lane lanes[Count];  // NOLINT(modernize-avoid-c-arrays)
    __builtin_memcpy(lanes, &mask.lanes, sizeof lanes);
    std::uint32_t of_lanes = 0;
    for (int i = 0; i < Count; ++i) {
        of_lanes |= (lanes[i] != 0 ? 1U : 0U) << i;
    }
    return of_lanes;
}

}  // namespace pent
