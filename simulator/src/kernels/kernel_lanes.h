#pragma once

#include <pent/register_bytes.h>
#include <pent/simd.h>

// The operations that kernels need, for a pack of numbers (one a lane) and for a single number, so
// that the same templates make the vector kernels and the scalar ones.
//
// Everything the kernels are made of is in an unnamed namespace: each instruction set compiles its
// own copy, and the linker must never merge them.

namespace pent::simulator {
namespace {  // NOLINT(google-build-namespaces): see above

template <typename Real>
struct Lanes {
    static constexpr int kCount = Real::kCount;
    using Number = typename Real::Value;
    using Mask = typename Real::Truth;

    static Real load(const double* from) { return Real::load(from); }
    static void store(const Real& value, Number* to) { value.store(to); }
    static Real load_stored(const Number* from) { return Real::load(from); }
    static Real select(const Mask& mask, const Real& yes, const Real& no) {
        return pent::select(mask, yes, no);
    }
    static bool any(const Mask& mask) { return pent::any(mask); }
    static Real root(const Real& value) { return pent::sqrt(value); }
    static Real abs(const Real& value) { return pent::abs(value); }
    static Real max(const Real& a, const Real& b) { return pent::max(a, b); }
    static Real multiply_add(const Real& a, const Real& b, const Real& c) {
        return pent::multiply_add(a, b, c);
    }
    static Number lane(const Real& value, int i) { return value.lanes[i]; }
    static void set_lane(Real& value, int i, Number number) { value.lanes[i] = number; }
};

template <typename Scalar>
struct OneLane {
    static constexpr int kCount = 1;
    using Number = Scalar;
    using Mask = bool;

    static Scalar load(const double* from) { return static_cast<Scalar>(*from); }
    static void store(Scalar value, Scalar* to) { *to = value; }
    static Scalar load_stored(const Scalar* from) { return *from; }
    static Scalar select(bool mask, Scalar yes, Scalar no) { return mask ? yes : no; }
    static bool any(bool mask) { return mask; }
    static Scalar root(Scalar value) {
        if constexpr (sizeof(Scalar) == sizeof(float)) {
            return __builtin_sqrtf(value);
        } else {
            return __builtin_sqrt(value);
        }
    }
    static Scalar abs(Scalar value) { return value < 0 ? -value : value; }
    static Scalar max(Scalar a, Scalar b) { return a < b ? b : a; }
    static Scalar multiply_add(Scalar a, Scalar b, Scalar c) { return a * b + c; }
    static Scalar lane(Scalar value, int /*i*/) { return value; }
    static void set_lane(Scalar& value, int /*i*/, Scalar number) { value = number; }
};

template <>
struct Lanes<float> : OneLane<float> {};
template <>
struct Lanes<double> : OneLane<double> {};

// The pack that fills the widest register of this instruction set.
template <typename Scalar>
using Widest = Pack<Scalar, kRegisterBytes / static_cast<int>(sizeof(Scalar))>;

}  // namespace
}  // namespace pent::simulator
