#pragma once

#include "kernels/kernel_columns.h"
#include "kernels/kernel_fronts.h"
#include "kernels/kernel_galerkin.h"
#include "kernels/kernel_hessian.h"
#include "kernels/kernel_modes.h"
#include "kernels/kernel_quadratic_hessian.h"
#include "kernels/kernel_rows.h"
#include "kernels/kernel_smoothed.h"
#include "kernels/kernel_sweeps.h"

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

template <int Dim, typename DoublePack>
constexpr BlockKernels block_kernels() {
    constexpr bool kIsVectorized = Lanes<DoublePack>::kCount > 1;
    return {.multiply_float = choose_multiply<Dim, float, kIsVectorized>(),
            .multiply_double = choose_multiply<Dim, double, kIsVectorized>(),
            .modes_float = mode_kernels<kModes<Dim>, kIsVectorized, float>(),
            .modes_double = mode_kernels<kModes<Dim>, kIsVectorized, double>(),
            .factor_columns_float = &factor_columns<Dim, DoublePack, float>,
            .factor_columns_double = &factor_columns<Dim, DoublePack, double>,
            .solve_columns = &solve_columns<Dim, kIsVectorized>,
            .sum_forces = &sum_forces<Dim, kIsVectorized>,
            .add_motions = &add_motions<Dim, kIsVectorized>,
            .galerkin_float = &galerkin<GalerkinOfVertices<Dim, kIsVectorized, float>, float>,
            .galerkin_double = &galerkin<GalerkinOfVertices<Dim, kIsVectorized, double>, double>,
            .galerkin_modes_float = &galerkin<GalerkinOfModes<Dim, kIsVectorized, float>, float>,
            .galerkin_modes_double = &galerkin<GalerkinOfModes<Dim, kIsVectorized, double>, double>,
            .eliminate_front = &eliminate_front<DoublePack>};
}

// The kernels for any number of corners would do for simplices, too, and give the same numbers to
// rounding. Simplices have kernels of their own for speed: with Dim + 1 corners known at compile
// time gradients take three quarters of the time, Hessians six sevenths (AVX2). What both share is
// in kernel_elements.h and kernel_hessian.h.

template <int Dim, typename Real>
RunEnergy add_gradient_of(const ElementRun& run, const double* positions, double* gradient) {
    if (run.kind == ElementKind::Quadratic) {
        return add_quadratic_gradient<Dim, Real>(run, positions, gradient);
    }
    return run.corners == Dim + 1 ? add_gradient<Dim, Real>(run, positions, gradient)
                                  : add_smoothed_gradient<Dim, Real>(run, positions, gradient);
}

template <int Dim, typename Real, typename Scalar>
std::int64_t add_hessian_of(const ElementRun& run,
                            const double* positions,
                            const HessianTarget<Scalar>& target) {
    if (run.kind == ElementKind::Quadratic) {
        return add_quadratic_hessian<Dim, Real>(run, positions, target);
    }
    return run.corners == Dim + 1 ? add_hessian<Dim, Real>(run, positions, target)
                                  : add_smoothed_hessian<Dim, Real>(run, positions, target);
}

template <int Dim, typename FloatPack, typename DoublePack>
constexpr Kernels<Dim> kernel_table() {
    return {.gradient = &add_gradient_of<Dim, DoublePack>,
            .hessian_float = &add_hessian_of<Dim, FloatPack, float>,
            .hessian_double = &add_hessian_of<Dim, DoublePack, double>,
            .blocks = block_kernels<Dim, DoublePack>()};
}

}  // namespace
}  // namespace pent::simulator
