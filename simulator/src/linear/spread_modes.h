#pragma once

#include "linear/linear_solver.h"
#include "linear/preconditioner.h"

#include <memory>
#include <vector>

namespace pent::simulator {

/// Rigid motions of aggregates beside a smoother, as multilevel() has them, for dofs that ranks
/// share:
///
///     z = S r + P C P^T r,     C near (P^T A P)^-1
///
/// C is a GatheredSolver where that is small, else it comes from Ranks::make_solver().
///
/// No aggregate crosses from one rank to another. One is made for each set of dofs, and for a
/// matrix at a time.
template <int Dim>
class SpreadModes {
public:
    /// @param pattern   Of the dofs that have rows; columns of other ranks are left out.
    /// @param geometry  Must outlive this.
    SpreadModes(const BlockPattern& pattern, const DofGeometry<Dim>& geometry);

    /// @param positions  Dim x dofs, where the vertices are now, m; of ghosts, too.
    /// @param ghosts     ghost_columns() of the matrix, and the exchange of these.
    template <typename Scalar>
    [[nodiscard]] std::unique_ptr<Preconditioner<Dim>> precondition(
        const Workers& workers,
        const BlockMatrix<Dim, Scalar>& matrix,
        const BlockVector<Dim>& positions,
        const std::vector<std::uint32_t>& ghosts,
        GhostExchange& exchange,
        std::unique_ptr<Preconditioner<Dim>> smoother) const;

    /// Of this rank.
    [[nodiscard]] const Aggregates& aggregates() const { return own_; }

private:
    const DofGeometry<Dim>* geometry_;
    Aggregates own_;
    std::vector<std::int64_t> counts_;  // of the aggregates of each rank
    std::int64_t first_ = 0;            // of the ranks before this one together
};

}  // namespace pent::simulator
