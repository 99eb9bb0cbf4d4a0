#pragma once

#include "linear/aggregate_matrix.h"

#include <vector>

namespace pent::simulator {

/// Smoothing by sweeps over the aggregates, D being the diagonal blocks of A = L + D + L^T.
///
/// Forth and back again they are symmetric, and for any positive definite A they make every error
/// smaller: unlike damped Jacobi they need no bound of the spectrum, which an estimate would miss
/// where few aggregates have the largest eigenvalues. Batches of the pattern run one after the
/// other: same bits for any number of threads.
///
/// Ranks sweep at the same time, each over its own aggregates, and know what others had before:
/// block Jacobi between them. So that errors do not grow for that, D becomes (1 + t) D with
///
///     t_i = max(0, sum_j s_ij - 1/2) / 2,     s_ij >= |D_i^-1/2 A_ij D_j^-1/2|
///
/// over the aggregates j of other ranks: L + D + (L + D)^T - A, which says how much smaller they
/// become [baker2011], is at least half of D then.
template <int Dim, typename Scalar>
class GaussSeidel {
public:
    using Vector = typename AggregateMatrix<Dim, Scalar>::Vector;
    using Shares = typename AggregateMatrix<Dim, Scalar>::Shares;

    GaussSeidel() = default;
    /// @param A  Must outlive this.
    GaussSeidel(const Workers& workers, const AggregateMatrix<Dim, Scalar>& A);

    /// From no guess: z = (L + D)^-1 r, over the columns. Its residual r - A z is left.
    ///
    /// @param shares  That fit A.
    void sweep_forth(const Workers& workers,
                     const BlockKernels& kernels,
                     const Vector& r,
                     Vector& z,
                     Vector& left,
                     Shares& shares) const;

    /// z += (D + L^T)^-1 (r - A z), z over the columns.
    void sweep_back(const Workers& workers,
                    const BlockKernels& kernels,
                    const Vector& r,
                    Vector& z,
                    Shares& shares) const;

private:
    static constexpr int kSize = kModes<Dim>;
    static constexpr std::int64_t kEntries = AggregateMatrix<Dim, Scalar>::kEntries;

    void damp(const Workers& workers);
    [[nodiscard]] ModeDiagonal<Scalar> diagonal() const {
        return {inverses_.data(), kept_.empty() ? nullptr : kept_.data()};
    }

    const AggregateMatrix<Dim, Scalar>* A_ = nullptr;
    std::vector<Scalar> inverses_;  // as ModeDiagonal has them
    std::vector<Scalar> kept_;      // the same; empty where t is zero
};

}  // namespace pent::simulator
