#pragma once

#include "linear/aggregate_matrix.h"

#include <vector>

namespace pent::simulator {

/// Smoother of coarse levels: block Gauss-Seidel over the aggregates, D being the diagonal blocks
/// of A = L + D + L^T.
///
/// A forward and a backward sweep together are symmetric, and reduce every error for any positive
/// definite A. Unlike damped Jacobi they need no bound of the spectrum, which estimates get wrong
/// where few aggregates have the largest eigenvalues. The batches of the pattern are relaxed one
/// after the other, the rows of a batch in parallel: same bits for any number of threads.
///
/// Ranks sweep at the same time, each over its own aggregates, with the ghosts that others had
/// before: hybrid Gauss-Seidel, which is block Jacobi between ranks. So that errors do not grow for
/// that, D becomes (1 + t) D with
///
///     t_i = max(0, sum_j s_ij - 1/2) / 2,     s_ij >= |D_i^-1/2 A_ij D_j^-1/2|
///
/// over the aggregates j of other ranks. With M = L + (1 + t) D then M + M^T - A is at least D / 2,
/// and errors become smaller where that is positive definite [baker2011].
template <int Dim, typename Scalar>
class GaussSeidel {
public:
    using Vector = typename AggregateMatrix<Dim, Scalar>::Vector;
    using Shares = typename AggregateMatrix<Dim, Scalar>::Shares;

    GaussSeidel() = default;
    /// @param A  Must outlive this.
    GaussSeidel(const Workers& workers, const AggregateMatrix<Dim, Scalar>& A);

    /// Forward sweep from zero: z = (L + D)^-1 r, over the columns; left = r - A z, its residual.
    ///
    /// @param shares  After A.fit().
    void sweep_forth(const Workers& workers,
                     const BlockKernels& kernels,
                     const Vector& r,
                     Vector& z,
                     Vector& left,
                     Shares& shares) const;

    /// Backward sweep: z += (D + L^T)^-1 (r - A z), z over the columns.
    void sweep_back(const Workers& workers,
                    const BlockKernels& kernels,
                    const Vector& r,
                    Vector& z,
                    Shares& shares) const;

private:
    static constexpr int kSize = kModes<Dim>;
    static constexpr std::int64_t kEntries = AggregateMatrix<Dim, Scalar>::kEntries;

    // Replaces D by (1 + t) D.
    void damp(const Workers& workers);
    [[nodiscard]] ModeDiagonal<Scalar> diagonal() const {
        return {inverses_.data(), kept_.empty() ? nullptr : kept_.data()};
    }

    const AggregateMatrix<Dim, Scalar>* A_ = nullptr;
    std::vector<Scalar> inverses_;  // see ModeDiagonal
    std::vector<Scalar> kept_;      // see ModeDiagonal; empty where t is zero
};

}  // namespace pent::simulator
