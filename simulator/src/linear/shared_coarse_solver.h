#pragma once

#include "linear/aggregate_places.h"
#include "linear/coarse_solver.h"
#include "linear/hierarchy.h"

#include <memory>
#include <vector>

namespace pent::simulator {

/// CoarseSolver where the rows of a matrix may be spread over ranks: each then has all rows and
/// solves for all, one message each way, as long as they are kMaxDense at most; what is larger is
/// for Ranks::make_solver().
template <int Dim, typename Scalar>
class SharedCoarseSolver {
public:
    using Vector = typename AggregateMatrix<Dim, Scalar>::Vector;

    SharedCoarseSolver() = default;
    /// @param level    Of the rows of A.
    /// @param places   Of the aggregates of this rank.
    /// @param sharing  Null where nothing is shared; must outlive this.
    SharedCoarseSolver(const Workers& workers,
                       const AggregateMatrix<Dim, Scalar>& A,
                       const HierarchyLevel& level,
                       const AggregatePlaces<Dim>& places,
                       const Sharing* sharing);

    /// z near A^-1 r over the rows of this rank; symmetric positive definite in r.
    void solve(const Workers& workers, const Vector& r, Vector& z) const;

private:
    const Sharing* sharing_ = nullptr;
    std::vector<std::int64_t> sizes_;       // numbers of each rank
    Eigen::Index first_ = 0;                // of this rank
    CoarseSolver<Dim, Scalar> whole_;       // unless there is the other
    std::unique_ptr<SpreadSolver> spread_;  // or null
};

}  // namespace pent::simulator
