#pragma once

#include "linear/block_matrix.h"
#include "linear/dof_map.h"
#include "linear/elimination.h"
#include "linear/hierarchy.h"

#include <pent/simulator/solver_options.h>

#include <memory>

namespace pent::simulator {

/// z = B r for a symmetric positive definite B near the inverse of a matrix.
template <int Dim>
class Preconditioner {
public:
    Preconditioner() = default;
    virtual ~Preconditioner() = default;
    Preconditioner(const Preconditioner&) = delete;
    Preconditioner& operator=(const Preconditioner&) = delete;
    Preconditioner(Preconditioner&&) = delete;
    Preconditioner& operator=(Preconditioner&&) = delete;

    /// One call at a time: it may have room of its own for what it does.
    ///
    /// @return  r . z over the rows of this rank, found on the way, to the precision of B.
    virtual double apply(const Workers& workers,
                         const BlockVector<Dim>& r,
                         BlockVector<Dim>& z) const = 0;

    /// Adds to x what a coarse space, if there is one, makes of the residual r: a better first
    /// guess. Bodies that move rigidly are then solved for at once.
    ///
    /// @return  Whether x has changed.
    [[nodiscard]] virtual bool correct(const Workers& /*workers*/,
                                       const BlockVector<Dim>& /*r*/,
                                       BlockVector<Dim>& /*x*/) const {
        return false;
    }
};

/// Block Jacobi along the columns of an extruded mesh: the dofs of all layers above one base
/// vertex are solved for together, by factorization of a band of blocks: layers up to two apart may
/// be coupled.
///
/// Thin layers couple the vertices of a column far more strongly than its neighbors, which is what
/// makes point-wise Jacobi slow there. Columns of single vertices are plain block Jacobi.
///
/// @param column_start  As DofMap::column_start(); single dofs for block Jacobi.
template <int Dim, typename Scalar>
[[nodiscard]] std::unique_ptr<Preconditioner<Dim>> column_jacobi(
    const Workers& workers,
    const BlockKernels& kernels,
    const BlockMatrix<Dim, Scalar>& matrix,
    const std::vector<std::uint32_t>& column_start);

/// Adds rigid motions of aggregates, on several levels, to a smoother:
///
///     z = S r + P C P^T r,     C near (P^T A P)^-1 by multigrid
///
/// The columns of P are the rigid motions of each aggregate (Dim translations and a rotation in
/// each of the Dim (Dim - 1) / 2 planes), which are what a smoother removes slowest. On the levels
/// below, C is a Gauss-Seidel sweep before and one after a correction by larger aggregates, which
/// is enlarged by 1.8, in a W-cycle; the coarsest is solved exactly. Plain aggregation [notay2010]
/// of rigid modes [vanek1996] with over-correction [braess1995].
///
/// Where ranks share the dofs each has a part of every level, its own aggregates, and their
/// vectors are exchanged beside the sweeps; the coarsest level is on all of them.
///
/// @param hierarchy  Must outlive the result.
/// @param positions  Dim x dofs, where the vertices are now, m; of this rank at least.
template <int Dim, typename Scalar>
[[nodiscard]] std::unique_ptr<Preconditioner<Dim>> multilevel(
    const Workers& workers,
    const BlockKernels& kernels,
    const BlockMatrix<Dim, Scalar>& matrix,
    const Hierarchy& hierarchy,
    const BlockVector<Dim>& positions,
    std::unique_ptr<Preconditioner<Dim>> smoother);

/// B = A^-1 by the factors of a matrix without a coupling, so that one iteration does.
///
/// @param elimination  Of the links of A; must outlive the result.
/// @return             Null where a pivot is not positive.
template <int Dim, typename Scalar>
[[nodiscard]] std::unique_ptr<Preconditioner<Dim>> exact_inverse(const BlockKernels& kernels,
                                                                 const BlockMatrix<Dim, Scalar>& A,
                                                                 const Elimination& elimination);

}  // namespace pent::simulator
