#pragma once

#include <pent/mask.h>

#include <cstddef>
#include <type_traits>
#include <utility>

namespace pent {

namespace detail {

// Count numbers from memory in a vector of another type. g++ 12 widens floats by halves, in five
// instructions where there is one.
template <typename Vector, typename Number, int Count, typename From>
PENT_SIMD_INLINE Vector converted(const From* from) {
    [[maybe_unused]] constexpr bool kWidens =
        std::is_same_v<Number, double> && std::is_same_v<From, float>;
#if defined(__AVX512F__)
    if constexpr (kWidens && Count == 8) {
        return reinterpret_cast<Vector>(_mm512_maskz_cvtps_pd(0xff, _mm256_loadu_ps(from)));
    }
#endif
#if defined(__AVX__)
    if constexpr (kWidens && Count == 4) {
        return reinterpret_cast<Vector>(_mm256_cvtps_pd(_mm_loadu_ps(from)));
    }
#endif
    typename VectorOf<From, Count>::Type read;
    __builtin_memcpy(&read, from, sizeof read);
    return __builtin_convertvector(read, Vector);
}

template <typename Vector, typename Number, std::size_t... Lane>
PENT_SIMD_INLINE Vector broadcast(Number value, std::index_sequence<Lane...> /*lanes*/) {
    return Vector{(static_cast<void>(Lane), value)...};
}

}  // namespace detail

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
        return Pack(detail::converted<Vector, Number, Count>(from));
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

}  // namespace pent
