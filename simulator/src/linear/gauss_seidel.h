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
template <int Dim, typename Scalar>
class GaussSeidel {
public:
    using Vector = typename AggregateMatrix<Dim, Scalar>::Vector;

    GaussSeidel() = default;
    /// @param A  Must outlive this.
    GaussSeidel(const Workers& workers, const AggregateMatrix<Dim, Scalar>& A);

    /// From no guess: z = (L + D)^-1 r. Its residual r - A z is left = -L^T z.
    void sweep_forth(const Workers& workers,
                     const BlockKernels& kernels,
                     const Vector& r,
                     Vector& z,
                     Vector& left) const;

    /// z += (D + L^T)^-1 (r - A z).
    void sweep_back(const Workers& workers,
                    const BlockKernels& kernels,
                    const Vector& r,
                    Vector& z) const;

private:
    static constexpr int kSize = kModes<Dim>;

    const AggregateMatrix<Dim, Scalar>* A_ = nullptr;
    std::vector<Eigen::Matrix<Scalar, kSize, kSize>> inverses_;  // of the diagonal blocks
};

}  // namespace pent::simulator
