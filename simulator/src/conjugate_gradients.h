#pragma once

#include "block_matrix.h"
#include "preconditioner.h"

namespace pent::simulator {

struct LinearSolveOptions {
    double tolerance = 1e-4;  ///< On |b - A x| / |b|.
    int max_iterations = 3000;
};

struct LinearSolveReport {
    int iterations = 0;
    double residual = 0;           ///< |b - A x| / |b| computed from x at the end; 0 if b = 0.
    bool has_converged = false;    ///< residual <= tolerance.
    bool has_broken_down = false;  ///< A direction p with p . A p <= 0 or not finite turned up.
    bool has_lost_inertia =
        false;  ///< Not tried: beside the stiffness the masses drown in rounding.
};

/// Vectors that a solve works in; kept between solves.
template <int Dim>
struct LinearSolveSpace {
    BlockVector<Dim> r;
    BlockVector<Dim> z;
    BlockVector<Dim> p;
    BlockVector<Dim> q;
};

/// Preconditioned conjugate gradients for A x = b, A symmetric positive definite.
///
/// The residual that is carried along drifts from the true one; the true one decides at the end,
/// and where it is too large the iteration starts again from there.
///
/// @param x  First guess in, solution out.
template <int Dim, typename Scalar>
[[nodiscard]] LinearSolveReport solve(const Workers& workers,
                                      const Kernels<Dim>& kernels,
                                      const BlockMatrix<Dim, Scalar>& A,
                                      const Preconditioner<Dim>& preconditioner,
                                      const BlockVector<Dim>& b,
                                      const LinearSolveOptions& options,
                                      LinearSolveSpace<Dim>& space,
                                      BlockVector<Dim>& x);

}  // namespace pent::simulator
