#pragma once

#include "simd_faults.h"

#include <pent/simd.h>

#include <cstddef>
#include <cstdint>

// Every operation on packs against the same on single numbers. In an unnamed namespace and without
// the inline functions of a library, like the kernels: one copy for each instruction set.

namespace pent::test {

namespace {  // NOLINT(google-build-namespaces): see above

// Multiplies and adds as the file is compiled for.
inline float multiply_add(float a, float b, float c) {
#if defined(__FMA__)
    return __builtin_fmaf(a, b, c);
#else
    return a * b + c;
#endif
}
inline double multiply_add(double a, double b, double c) {
#if defined(__FMA__)
    return __builtin_fma(a, b, c);
#else
    return a * b + c;
#endif
}
inline float root(float a) {
    return __builtin_sqrtf(a);
}
inline double root(double a) {
    return __builtin_sqrt(a);
}

// The same bits, or both NaN: which one is not defined.
template <typename Number>
bool is_same(Number a, Number b) {
    return __builtin_memcmp(&a, &b, sizeof a) == 0 || (a != a && b != b);
}

// Zeros, infinities, NaN, the ends of the range, and numbers of all sizes.
template <typename Number>
Number number(std::uint32_t& state) {
    constexpr bool kIsFloat = sizeof(Number) == sizeof(float);
    constexpr Number kSpecial[] = {Number(0.0),
                                   Number(-0.0),
                                   Number(1),
                                   Number(-1),
                                   Number(__builtin_inf()),
                                   Number(-__builtin_inf()),
                                   Number(__builtin_nan("")),
                                   kIsFloat ? Number(1.5e-45F) : Number(5e-324),
                                   kIsFloat ? Number(3.4e38F) : Number(1.7e308)};
    state = state * 1664525U + 1013904223U;
    const std::uint32_t which = (state >> 16) % 32;
    if (which < sizeof kSpecial / sizeof(Number)) {
        return kSpecial[which];
    }
    state = state * 1664525U + 1013904223U;
    Number value = static_cast<Number>(static_cast<std::int32_t>(state)) / Number(1 << 30);
    for (std::uint32_t i = 0; i < which % 8; ++i) {
        value *= (state & 1U) != 0 ? Number(37) : Number(0.03F);
    }
    return value;
}

template <typename Number, int Count>
struct Sample {
    alignas(64) Number at[Count];

    explicit Sample(std::uint32_t& state) {
        for (Number& value : at) {
            value = number<Number>(state);
        }
    }
};

template <typename Number, int Count, typename Expected>
bool holds(const Pack<Number, Count>& pack, const Expected& expected) {
    Number stored[Count + 1];
    pack.store(stored + 1);  // of no alignment
    for (int i = 0; i < Count; ++i) {
        if (!is_same(stored[i + 1], expected(i)) || !is_same(pack.lanes[i], expected(i))) {
            return false;
        }
    }
    return true;
}

template <typename Number, int Count, typename Expected>
bool holds(const Mask<Number, Count>& mask, const Expected& expected) {
    bool is_any = false;
    std::uint32_t set = 0;
    bool is_all = true;
    bool is_right = true;
    for (int i = 0; i < Count; ++i) {
        is_any = is_any || expected(i);
        set |= (expected(i) ? 1U : 0U) << i;
        is_all = is_all && expected(i);
        is_right = is_right && mask.lanes[i] == (expected(i) ? -1 : 0);
    }
    return is_right && any(mask) == is_any && all(mask) == is_all && bits(mask) == set;
}

template <typename Number, int Count>
const char* arithmetic_fault(const Number* a, const Number* b, const Number* c) {
    using Real = Pack<Number, Count>;
    const Real x = Real::load_aligned(a);
    const Real y = Real::load(b);
    const Real z = Real::load(c);
    Real sum = x;
    sum += y;
    Real difference = x;
    difference -= y;
    Real product = x;
    product *= y;
    Real quotient = x;
    quotient /= y;
    if (!holds(x, [&](int i) { return a[i]; }) || !holds(y, [&](int i) { return b[i]; })) {
        return "load";
    }
    if (!holds(Real(b[0]), [&](int) { return b[0]; })) {
        return "broadcast";
    }
    if (!holds(x + y, [&](int i) { return a[i] + b[i]; })
        || !holds(sum, [&](int i) { return a[i] + b[i]; })) {
        return "+";
    }
    if (!holds(x - y, [&](int i) { return a[i] - b[i]; })
        || !holds(difference, [&](int i) { return a[i] - b[i]; })
        || !holds(-x, [&](int i) { return -a[i]; })) {
        return "-";
    }
    if (!holds(x * y, [&](int i) { return a[i] * b[i]; })
        || !holds(product, [&](int i) { return a[i] * b[i]; })) {
        return "*";
    }
    if (!holds(x / y, [&](int i) { return a[i] / b[i]; })
        || !holds(quotient, [&](int i) { return a[i] / b[i]; })) {
        return "/";
    }
    if (!holds(pent::multiply_add(x, y, z),
               [&](int i) { return multiply_add(a[i], b[i], c[i]); })) {
        return "multiply_add";
    }
    return nullptr;
}

template <typename Number, int Count>
const char* function_fault(const Number* a, const Number* b) {
    using Real = Pack<Number, Count>;
    const Real x = Real::load(a);
    const Real y = Real::load(b);
    if (!holds(sqrt(x), [&](int i) { return root(a[i]); })) {
        return "sqrt";
    }
    if (!holds(abs(x), [&](int i) { return __builtin_signbit(a[i]) != 0 ? -a[i] : a[i]; })) {
        return "abs";
    }
    if (!holds(min(x, y), [&](int i) { return a[i] < b[i] ? a[i] : b[i]; })) {
        return "min";
    }
    if (!holds(max(x, y), [&](int i) { return a[i] > b[i] ? a[i] : b[i]; })) {
        return "max";
    }
    if (!holds(select(x < y, x, y), [&](int i) { return a[i] < b[i] ? a[i] : b[i]; })) {
        return "select";
    }
    return nullptr;
}

template <typename Number, int Count>
const char* comparison_fault(const Number* a, const Number* b) {
    using Real = Pack<Number, Count>;
    const Real x = Real::load(a);
    const Real y = Real::load(b);
    const Real zero = Real(Number(0));
    if (!holds(x < y, [&](int i) { return a[i] < b[i]; })) {
        return "<";
    }
    if (!holds(x <= y, [&](int i) { return a[i] <= b[i]; })) {
        return "<=";
    }
    if (!holds(x > y, [&](int i) { return a[i] > b[i]; })) {
        return ">";
    }
    if (!holds(x >= y, [&](int i) { return a[i] >= b[i]; })) {
        return ">=";
    }
    if (!holds(x == y, [&](int i) { return a[i] == b[i]; })) {
        return "==";
    }
    if (!holds(!(x < y), [&](int i) { return !(a[i] < b[i]); })) {
        return "!";
    }
    if (!holds(x < y && y < zero, [&](int i) { return a[i] < b[i] && b[i] < 0; })) {
        return "&&";
    }
    if (!holds(x < y || y < zero, [&](int i) { return a[i] < b[i] || b[i] < 0; })) {
        return "||";
    }
    // One lane after the other, alone true and alone false.
    for (int lane = 0; lane < Count; ++lane) {
        Number values[Count] = {};
        values[lane] = 1;
        const Real one = Real::load(values);
        if (!holds(one > zero, [&](int i) { return i == lane; })
            || !holds(one <= zero, [&](int i) { return i != lane; })) {
            return "any, all or bits";
        }
    }
    return holds(x < x, [](int) { return false; }) ? nullptr : "any of none";
}

// Of packs and of vectors of the compiler.
template <typename Number, int Count>
const char* transposition_fault(std::uint32_t& state) {
    using Real = Pack<Number, Count>;
    Number from[Count][Count];
    Real packs[Count];
    typename Real::Vector vectors[Count];
    for (int i = 0; i < Count; ++i) {
        for (int j = 0; j < Count; ++j) {
            from[i][j] = number<Number>(state);
        }
        packs[i] = Real::load(from[i]);
        vectors[i] = packs[i].lanes;
    }
    transpose<Count>(packs);
    transpose<Count>(vectors);
    for (int i = 0; i < Count; ++i) {
        const auto expected = [&](int j) { return from[j][i]; };
        if (!holds(packs[i], expected) || !holds(Real(vectors[i]), expected)) {
            return "transpose";
        }
    }
    return nullptr;
}

template <typename Number, int Count>
const char* fault_of_packs() {
    std::uint32_t state = Count;
    for (int round = 0; round < 500; ++round) {
        const Sample<Number, Count> a(state);
        const Sample<Number, Count> b(state);
        const Sample<Number, Count> c(state);
        const Sample<float, Count> floats(state);
        const Sample<double, Count> doubles(state);
        const char* const faults[] = {
            arithmetic_fault<Number, Count>(a.at, b.at, c.at),
            function_fault<Number, Count>(a.at, b.at), comparison_fault<Number, Count>(a.at, b.at),
            transposition_fault<Number, Count>(state),
            holds(Pack<Number, Count>::load(floats.at),
                  [&](int i) { return static_cast<Number>(floats.at[i]); })
                    && holds(Pack<Number, Count>::load(doubles.at),
                             [&](int i) { return static_cast<Number>(doubles.at[i]); })
                ? nullptr
                : "load of another type"};
        for (const char* fault : faults) {
            if (fault != nullptr) {
                return fault;
            }
        }
    }
    return nullptr;
}

inline const char* simd_fault() {
    const char* const faults[] = {fault_of_packs<float, 2>(),  fault_of_packs<float, 4>(),
                                  fault_of_packs<float, 8>(),  fault_of_packs<float, 16>(),
                                  fault_of_packs<double, 2>(), fault_of_packs<double, 4>(),
                                  fault_of_packs<double, 8>(), fault_of_packs<double, 16>()};
    for (const char* fault : faults) {
        if (fault != nullptr) {
            return fault;
        }
    }
    return nullptr;
}

}  // namespace
}  // namespace pent::test
