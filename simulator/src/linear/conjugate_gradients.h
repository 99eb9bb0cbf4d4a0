#pragma once

#include "linear/block_matrix.h"
#include "linear/linear_solve.h"
#include "linear/preconditioner.h"

namespace pent::simulator {

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
[[nodiscard]] LinearSolveReport conjugate_gradients(const Workers& workers,
                                                    const BlockKernels& kernels,
                                                    const BlockMatrix<Dim, Scalar>& A,
                                                    const Preconditioner<Dim>& preconditioner,
                                                    const BlockVector<Dim>& b,
                                                    const LinearSolveOptions& options,
                                                    LinearSolveSpace<Dim>& space,
                                                    BlockVector<Dim>& x);

}  // namespace pent::simulator
