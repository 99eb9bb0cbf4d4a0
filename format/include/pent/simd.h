#pragma once

#include <cstdint>
#include <utility>

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

template <typename Vector, typename Number, std::size_t... Lane>
PENT_SIMD_INLINE Vector broadcast(Number value, std::index_sequence<Lane...> /*lanes*/) {
    return Vector{(static_cast<void>(Lane), value)...};
}

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

/// Count floats or doubles; Count is a power of two, at least 2. Arithmetic is lane by lane and as
/// that of one Number, NaN and signed zeros included.
template <typename Number, int Count>
struct Pack {
    using Vector = typename detail::VectorOf<Number, Count>::Type;
    using Value = Number;
    using Truth = Mask<Number, Count>;
    static constexpr int kCount = Count;

    Vector lanes;

    Pack() = default;  // of any numbers: to be filled

    [[gnu::always_inline]] explicit Pack(const Vector& of_lanes) : lanes(of_lanes) {}

    /// The same number in every lane.
    [[gnu::always_inline]] explicit Pack(Number value)
        : lanes(detail::broadcast<Vector>(value, std::make_index_sequence<Count>())) {}

    /// From Count numbers in memory, rounded to Number if they are of another type.
    template <typename From>
    PENT_SIMD_INLINE static Pack load(const From* from) {
        typename detail::VectorOf<From, Count>::Type read;
        __builtin_memcpy(&read, from, sizeof read);
        return Pack(__builtin_convertvector(read, Vector));
    }

    /// The same from an address that is a multiple of the size of the pack; not checked.
    PENT_SIMD_INLINE static Pack load_aligned(const Number* from) {
        return Pack(*static_cast<const Vector*>(__builtin_assume_aligned(from, sizeof(Vector))));
    }

    [[gnu::always_inline]] void store(Number* to) const {
        __builtin_memcpy(to, &lanes, sizeof lanes);
    }

    [[gnu::always_inline]] Pack& operator+=(const Pack& b) { return *this = *this + b; }
    [[gnu::always_inline]] Pack& operator-=(const Pack& b) { return *this = *this - b; }
    [[gnu::always_inline]] Pack& operator*=(const Pack& b) { return *this = *this * b; }
    [[gnu::always_inline]] Pack& operator/=(const Pack& b) { return *this = *this / b; }

    PENT_SIMD_INLINE friend Pack operator-(const Pack& a) { return Pack(-a.lanes); }
    PENT_SIMD_INLINE friend Pack operator+(const Pack& a, const Pack& b) {
        return Pack(a.lanes + b.lanes);
    }
    PENT_SIMD_INLINE friend Pack operator-(const Pack& a, const Pack& b) {
        return Pack(a.lanes - b.lanes);
    }
    PENT_SIMD_INLINE friend Pack operator*(const Pack& a, const Pack& b) {
        return Pack(a.lanes * b.lanes);
    }
    PENT_SIMD_INLINE friend Pack operator/(const Pack& a, const Pack& b) {
        return Pack(a.lanes / b.lanes);
    }

    PENT_SIMD_INLINE friend Truth operator<(const Pack& a, const Pack& b) {
        return {a.lanes < b.lanes};
    }
    PENT_SIMD_INLINE friend Truth operator<=(const Pack& a, const Pack& b) {
        return {a.lanes <= b.lanes};
    }
    PENT_SIMD_INLINE friend Truth operator>(const Pack& a, const Pack& b) {
        return {a.lanes > b.lanes};
    }
    PENT_SIMD_INLINE friend Truth operator>=(const Pack& a, const Pack& b) {
        return {a.lanes >= b.lanes};
    }
    PENT_SIMD_INLINE friend Truth operator==(const Pack& a, const Pack& b) {
        return {a.lanes == b.lanes};
    }
};

/// Lanes of `yes` where the mask is true, of `no` elsewhere.
template <typename Number, int Count>
PENT_SIMD_INLINE Pack<Number, Count> select(const Mask<Number, Count>& mask,
                                            const Pack<Number, Count>& yes,
                                            const Pack<Number, Count>& no) {
    return Pack<Number, Count>(mask.lanes ? yes.lanes : no.lanes);
}

/// a < b ? a : b, lane by lane: b where one of them is NaN.
template <typename Number, int Count>
PENT_SIMD_INLINE Pack<Number, Count> min(const Pack<Number, Count>& a,
                                         const Pack<Number, Count>& b) {
    return Pack<Number, Count>(a.lanes < b.lanes ? a.lanes : b.lanes);
}

/// a > b ? a : b, lane by lane: b where one of them is NaN.
template <typename Number, int Count>
PENT_SIMD_INLINE Pack<Number, Count> max(const Pack<Number, Count>& a,
                                         const Pack<Number, Count>& b) {
    return Pack<Number, Count>(a.lanes > b.lanes ? a.lanes : b.lanes);
}

/// Without its sign bit.
template <typename Number, int Count>
PENT_SIMD_INLINE Pack<Number, Count> abs(const Pack<Number, Count>& a) {
    using Bits = typename Mask<Number, Count>::Vector;
    using Vector = typename Pack<Number, Count>::Vector;
    const auto sign = reinterpret_cast<Bits>(Pack<Number, Count>(Number(-0.0)).lanes);
    return Pack<Number, Count>(reinterpret_cast<Vector>(~sign & reinterpret_cast<Bits>(a.lanes)));
}

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

}  // namespace pent

#undef PENT_SIMD_INLINE
