#pragma once

#include "linear/aggregate_matrix.h"

#include <Eigen/Cholesky>

#include <vector>

namespace pent::simulator {

/// Regularizes what is singular in a coarse matrix: modes that an aggregate does not have
/// (rotations of a single vertex) and modes that depend on one another (of vertices on a line). The
/// shift is of the size of rounding; whatever a solution has in such modes moves no vertex.
///
/// @tparam Scalar  In which the matrix was summed up.
template <typename Scalar, typename Matrix>
void make_definite(Matrix& A) {
    // Well above the rounding of sums of blocks, well below what inertia is beside the stiffness
    // where it counts.
    constexpr double kRelativeShift = sizeof(Scalar) == sizeof(float) ? 2e-6 : 1e-10;
    for (Eigen::Index k = 0; k < A.rows(); ++k) {
        A(k, k) = A(k, k) > 0 ? (1 + kRelativeShift) * A(k, k) : 1;
    }
}

/// Solver of the coarsest level: a dense Cholesky factorization for each connected component.
///
/// A component of more than kMaxDense aggregates (a heap of that many bodies that touch), or one
/// that rounding has left indefinite, gets damped block Jacobi instead: inverses of the diagonal
/// blocks, each divided by the number of blocks in its row, so that no correction is too large.
template <int Dim, typename Scalar>
class CoarseSolver {
public:
    static constexpr std::size_t kMaxDense = 64;
    using Vector = typename AggregateMatrix<Dim, Scalar>::Vector;

    CoarseSolver() = default;
    CoarseSolver(const Workers& workers, const AggregateMatrix<Dim, Scalar>& A);

    /// z near A^-1 r; the result is symmetric positive definite in r.
    void solve(const Workers& workers, const Vector& r, Vector& z) const;

private:
    struct Component {
        std::vector<std::uint32_t> rows;
        Eigen::LLT<Eigen::MatrixXd> factors;
        // Of damped block Jacobi; empty where `factors` are used.
        std::vector<Eigen::Matrix<double, kModes<Dim>, kModes<Dim>>> inverses;
    };

    std::vector<Component> components_;
};

/// The inverse of a diagonal block, after make_definite().
template <int Dim, typename Scalar>
[[nodiscard]] Eigen::Matrix<double, kModes<Dim>, kModes<Dim>> inverse_of_diagonal(
    const AggregateMatrix<Dim, Scalar>& A, std::uint32_t row);

}  // namespace pent::simulator
