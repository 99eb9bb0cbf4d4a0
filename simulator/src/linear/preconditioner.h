#pragma once

#include "linear/block_matrix.h"
#include "linear/dof_map.h"
#include "linear/elimination.h"
#include "linear/hierarchy.h"

#include <pent/simulator/solver_options.h>

#include <memory>

namespace pent::simulator {

/// z = B r for a symmetric positive definite B that approximates the inverse of a matrix.
template <int Dim>
class Preconditioner {
public:
    Preconditioner() = default;
    virtual ~Preconditioner() = default;
    Preconditioner(const Preconditioner&) = delete;
    Preconditioner& operator=(const Preconditioner&) = delete;
    Preconditioner(Preconditioner&&) = delete;
    Preconditioner& operator=(Preconditioner&&) = delete;

    /// Not to be called concurrently: implementations may have scratch of their own.
    ///
    /// @return  r . z over the rows of this rank, a by-product, as exact as B.
    virtual double apply(const Workers& workers,
                         const BlockVector<Dim>& r,
                         BlockVector<Dim>& z) const = 0;

    /// Adds to x the correction of the coarse space, if there is one, for the residual r: a better
    /// initial guess. Bodies that only move rigidly are then solved for at once.
    ///
    /// @return  Whether x has changed.
    [[nodiscard]] virtual bool correct(const Workers& /*workers*/,
                                       const BlockVector<Dim>& /*r*/,
                                       BlockVector<Dim>& /*x*/) const {
        return false;
    }
};

/// Line Jacobi along the columns of an extruded mesh: the dofs of all layers above one base vertex
/// are solved for together, by a banded block factorization (layers up to two apart are coupled).
///
/// Thin layers couple the vertices of a column far more strongly to one another than to those of
/// other columns, which makes point-wise Jacobi slow. With columns of single vertices it is plain
/// block Jacobi.
///
/// @param column_start  As DofMap::column_start(); single dofs for block Jacobi. Must outlive the
///                      result.
template <int Dim, typename Scalar>
[[nodiscard]] std::unique_ptr<Preconditioner<Dim>> column_jacobi(
    const Workers& workers,
    const BlockKernels& kernels,
    const BlockMatrix<Dim, Scalar>& matrix,
    const std::vector<std::uint32_t>& column_start);

/// Aggregation multigrid over a smoother S:
///
///     z = S r + P C P^T r,     C near (P^T A P)^-1
///
/// The columns of P are the rigid modes of each aggregate (Dim translations and a rotation in each
/// of the Dim (Dim - 1) / 2 planes), the errors that a smoother removes slowest. C is a W-cycle
/// over ever larger aggregates: a Gauss-Seidel sweep before and one after a coarse correction,
/// which is enlarged by 1.8; the coarsest level is solved exactly. Plain aggregation [notay2010] of
/// rigid modes [vanek1996] with over-correction [braess1995].
///
/// With ranks each has its own aggregates of every level, and halos of vectors over aggregates are
/// exchanged between sweeps; the coarsest level is solved on all ranks together.
///
/// @param hierarchy  Must outlive the result.
/// @param positions  Dim x dofs, where the vertices are now, m; ghosts are not read.
template <int Dim, typename Scalar>
[[nodiscard]] std::unique_ptr<Preconditioner<Dim>> multilevel(
    const Workers& workers,
    const BlockKernels& kernels,
    const BlockMatrix<Dim, Scalar>& matrix,
    const Hierarchy& hierarchy,
    const BlockVector<Dim>& positions,
    std::unique_ptr<Preconditioner<Dim>> smoother);

/// B = A^-1 by a Cholesky factorization of A: one iteration of conjugate gradients will do.
///
/// @param elimination  Of the links of A and of its coupling; must outlive the result.
/// @return             Null where a pivot is not positive.
template <int Dim, typename Scalar>
[[nodiscard]] std::unique_ptr<Preconditioner<Dim>> exact_inverse(const BlockKernels& kernels,
                                                                 const BlockMatrix<Dim, Scalar>& A,
                                                                 const Elimination& elimination);

}  // namespace pent::simulator
