#pragma once

#include "kernel_elements.h"
#include "kernel_rows.h"

// The table of kernels of one instruction set, from its packs of floats and of doubles.

namespace pent::simulator {
namespace {  // NOLINT(google-build-namespaces): see kernel_lanes.h

template <int Dim, typename FloatPack, typename DoublePack>
constexpr Kernels<Dim> kernel_table() {
    return {.forces = &add_forces<Dim, DoublePack>,
            .hessian_float = &add_hessian<Dim, FloatPack, float>,
            .hessian_double = &add_hessian<Dim, DoublePack, double>,
            .multiply_float = &multiply_rows<Dim, float>,
            .multiply_double = &multiply_rows<Dim, double>};
}

}  // namespace
}  // namespace pent::simulator
