#pragma once

#include "linear/aggregate_matrix.h"

#include <Eigen/Cholesky>

#include <vector>

namespace pent::simulator {

/// Makes zero and dependent modes, those that an aggregate does not have (rotations of a single
/// vertex) or that say the same twice (of vertices on a line), definite at the size of rounding:
/// nothing they are given moves a vertex.
///
/// @tparam Scalar  That the matrix was added up in.
template <typename Scalar, typename Matrix>
void make_definite(Matrix& A) {
    // Well above the rounding of sums of blocks, well below what inertia must keep of the
    // stiffness.
    constexpr double kRelativeShift = sizeof(Scalar) == sizeof(float) ? 2e-6 : 1e-10;
    for (Eigen::Index k = 0; k < A.rows(); ++k) {
        A(k, k) = A(k, k) > 0 ? (1 + kRelativeShift) * A(k, k) : 1;
    }
}

/// Solves on the coarsest level: each component of linked aggregates by a dense factorization of
/// its own.
///
/// A component of more than kMaxDense aggregates (a heap of that many bodies that touch), or one
/// that rounding has left indefinite, is solved for by the inverses of its diagonal blocks, each
/// divided by the number of blocks in its row: an approximation from below.
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
        std::vector<Eigen::Matrix<double, kModes<Dim>, kModes<Dim>>> inverses;  // if not factored
    };

    std::vector<Component> components_;
};

/// The inverse of a diagonal block, made definite.
template <int Dim, typename Scalar>
[[nodiscard]] Eigen::Matrix<double, kModes<Dim>, kModes<Dim>> inverse_of_diagonal(
    const AggregateMatrix<Dim, Scalar>& A, std::uint32_t row);

}  // namespace pent::simulator
