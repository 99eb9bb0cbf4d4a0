#pragma once

#include <experimental/simd>

// What the kernels need of a number, for one number and for a pack of numbers (one a lane).
//
// Everything the kernels are made of is in an unnamed namespace: each instruction set compiles its
// own copy, and the linker must never merge them.

namespace pent::simulator {
namespace {  // NOLINT(google-build-namespaces): see above

template <typename Real>
struct Lanes {
    static constexpr int kCount = static_cast<int>(Real::size());
    using Number = typename Real::value_type;
    using Mask = typename Real::mask_type;

    static Real load(const double* from) {
        const std::experimental::fixed_size_simd<double, kCount> wide(
            from, std::experimental::element_aligned);
        return std::experimental::static_simd_cast<Real>(wide);
    }
    static void store(const Real& value, Number* to) {
        value.copy_to(to, std::experimental::element_aligned);
    }
    static Real select(const Mask& mask, const Real& yes, const Real& no) {
        Real value = no;
        std::experimental::where(mask, value) = yes;
        return value;
    }
    static bool any(const Mask& mask) { return std::experimental::any_of(mask); }
    static Real root(const Real& value) { return std::experimental::sqrt(value); }
    static Real abs(const Real& value) { return std::experimental::abs(value); }
    static Real max(const Real& a, const Real& b) { return std::experimental::max(a, b); }
    static Number lane(const Real& value, int i) { return value[static_cast<std::size_t>(i)]; }
    static void set_lane(Real& value, int i, Number number) {
        value[static_cast<std::size_t>(i)] = number;
    }
};

template <typename Scalar>
struct OneLane {
    static constexpr int kCount = 1;
    using Number = Scalar;
    using Mask = bool;

    static Scalar load(const double* from) { return static_cast<Scalar>(*from); }
    static void store(Scalar value, Scalar* to) { *to = value; }
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
    static Scalar lane(Scalar value, int /*i*/) { return value; }
    static void set_lane(Scalar& value, int /*i*/, Scalar number) { value = number; }
};

template <>
struct Lanes<float> : OneLane<float> {};
template <>
struct Lanes<double> : OneLane<double> {};

}  // namespace
}  // namespace pent::simulator
