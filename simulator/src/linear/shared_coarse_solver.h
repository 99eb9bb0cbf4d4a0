#pragma once

#include "linear/aggregate_places.h"
#include "linear/coarse_solver.h"
#include "linear/hierarchy.h"

#include <memory>
#include <vector>

namespace pent::simulator {

/// Solver of the coarsest level where its rows may be spread over ranks. Up to kMaxDense rows are
/// gathered on every rank, each of which factors and solves the whole, so that a solve takes one
/// gathering; more are left to Ranks::make_solver(). Without ranks a CoarseSolver.
template <int Dim, typename Scalar>
class SharedCoarseSolver {
public:
    using Vector = typename AggregateMatrix<Dim, Scalar>::Vector;

    SharedCoarseSolver() = default;
    /// @param level    Of which A is the matrix.
    /// @param places   Of the aggregates of this rank.
    /// @param sharing  Null without ranks; must outlive this.
    SharedCoarseSolver(const Workers& workers,
                       const AggregateMatrix<Dim, Scalar>& A,
                       const HierarchyLevel& level,
                       const AggregatePlaces<Dim>& places,
                       const Sharing* sharing);

    /// z near A^-1 r over the rows of this rank; symmetric positive definite in r.
    void solve(const Workers& workers, const Vector& r, Vector& z) const;

private:
    const Sharing* sharing_ = nullptr;
    std::vector<std::int64_t> sizes_;       // how many numbers of a vector each rank has
    Eigen::Index first_ = 0;                // first number of this rank
    CoarseSolver<Dim, Scalar> whole_;       // unused where there is spread_
    std::unique_ptr<SpreadSolver> spread_;  // null where whole_ is used
};

}  // namespace pent::simulator
