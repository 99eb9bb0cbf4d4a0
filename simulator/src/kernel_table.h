#pragma once

#include "kernel_elements.h"
#include "kernel_rows.h"

// The table of kernels of one instruction set, from its packs of floats and of doubles.

namespace pent::simulator {
namespace {  // NOLINT(google-build-namespaces): see kernel_lanes.h

template <int Dim, typename Scalar, bool IsVectorized>
constexpr auto choose_multiply() {
    if constexpr (Dim == 4 && IsVectorized) {
        return &multiply_rows_4<Scalar>;
    } else {
        return &multiply_rows<Dim, Scalar>;
    }
}

template <int Dim, typename FloatPack, typename DoublePack>
constexpr Kernels<Dim> kernel_table() {
    constexpr bool kIsVectorized = Lanes<DoublePack>::kCount > 1;
    return {.forces = &add_forces<Dim, DoublePack>,
            .hessian_float = &add_hessian<Dim, FloatPack, float>,
            .hessian_double = &add_hessian<Dim, DoublePack, double>,
            .multiply_float = choose_multiply<Dim, float, kIsVectorized>(),
            .multiply_double = choose_multiply<Dim, double, kIsVectorized>()};
}

}  // namespace
}  // namespace pent::simulator
