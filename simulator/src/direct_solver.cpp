#include "direct_solver.h"

#include <Eigen/SparseCholesky>

namespace pent::simulator {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

using Entries = std::vector<Eigen::Triplet<double>>;

// The stored triangle, entry by entry: rows of blocks below the diagonal of A^T = A.
template <int Dim, typename Scalar>
void add_lower_triangle(const BlockMatrix<Dim, Scalar>& A, Entries& entries) {
    const BlockPattern& pattern = A.pattern();
    for (std::int64_t row = 0; row < A.rows(); ++row) {
        const auto r = static_cast<std::size_t>(row);
        for (std::int64_t k = pattern.row_start[r]; k < pattern.row_start[r + 1]; ++k) {
            const auto column =
                static_cast<std::int64_t>(pattern.columns[static_cast<std::size_t>(k)]);
            for (int i = 0; i < Dim; ++i) {
                for (int j = 0; j < Dim; ++j) {
                    entries.emplace_back(static_cast<int>(Dim * column + j),
                                         static_cast<int>(Dim * row + i),
                                         static_cast<double>(A.block(k)(i, j)));
                }
            }
        }
    }
}

// Both parts of the matrix.
template <int Dim, typename Scalar>
Sparse lower_triangle(const BlockMatrix<Dim, Scalar>& A) {
    Entries entries;
    add_lower_triangle(A, entries);
    if (A.coupling() != nullptr) {
        add_lower_triangle(*A.coupling(), entries);
    }
    const auto size = static_cast<Eigen::Index>(Dim * A.rows());
    Sparse lower(size, size);
    lower.setFromTriplets(entries.begin(), entries.end());
    return lower;
}

}  // namespace

template <int Dim, typename Scalar>
LinearSolveReport solve_directly(const BlockMatrix<Dim, Scalar>& A,
                                 const BlockVector<Dim>& b,
                                 BlockVector<Dim>& x) {
    LinearSolveReport report;
    const double b_norm = b.norm();
    const Sparse lower = lower_triangle(A);
    const Eigen::SimplicialLDLT<Sparse, Eigen::Lower> factors(lower);
    report.has_broken_down =
        factors.info() != Eigen::Success || !(factors.vectorD().minCoeff() > 0);
    if (report.has_broken_down || b_norm == 0) {
        x.setZero();
        report.has_converged = !report.has_broken_down;
        return report;
    }
    x.reshaped() = factors.solve(b.reshaped());
    const Eigen::VectorXd left =
        b.reshaped() - lower.selfadjointView<Eigen::Lower>() * x.reshaped();
    report.residual = left.norm() / b_norm;
    report.has_converged = std::isfinite(report.residual);
    return report;
}

#define PENT_INSTANTIATE(Dim, Scalar)                                          \
    template LinearSolveReport solve_directly(const BlockMatrix<Dim, Scalar>&, \
                                              const BlockVector<Dim>&, BlockVector<Dim>&);
PENT_INSTANTIATE(3, float)
PENT_INSTANTIATE(3, double)
PENT_INSTANTIATE(4, float)
PENT_INSTANTIATE(4, double)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
