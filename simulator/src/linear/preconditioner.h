#pragma once

#include "linear/aggregates.h"
#include "linear/block_matrix.h"
#include "linear/dof_map.h"

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

    virtual void apply(const Workers& workers,
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

/// Block Jacobi along the columns of an extruded mesh: the unknowns of all layers above one base
/// vertex are solved for together, by factorization of a band of blocks: layers up to two apart may
/// be coupled.
///
/// Thin layers couple the vertices of a column far more strongly than its neighbors, which is what
/// makes point-wise Jacobi slow there. Columns of single vertices are plain block Jacobi.
///
/// @param numbering  With column_start; pass single-vertex columns for block Jacobi.
template <int Dim, typename Scalar>
[[nodiscard]] std::unique_ptr<Preconditioner<Dim>> column_jacobi(
    const Workers& workers,
    const BlockMatrix<Dim, Scalar>& matrix,
    const std::vector<std::uint32_t>& column_start);

/// Adds a coarse space to a smoother: z = S r + P (P^T A P)^-1 P^T r.
///
/// The columns of P are the rigid motions of each aggregate (Dim translations and a rotation in
/// each of the Dim (Dim - 1) / 2 planes), which are what a smoother removes slowest.
/// Gives the smoother alone if P^T A P cannot be factored.
///
/// @param positions  Dim x unknowns, where the vertices are now, m.
template <int Dim, typename Scalar>
[[nodiscard]] std::unique_ptr<Preconditioner<Dim>> with_rigid_modes(
    const Workers& workers,
    const BlockMatrix<Dim, Scalar>& matrix,
    const Aggregates& aggregates,
    const BlockVector<Dim>& positions,
    std::unique_ptr<Preconditioner<Dim>> smoother);

}  // namespace pent::simulator
