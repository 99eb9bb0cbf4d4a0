#include "linear/linear_solver.h"

#include <Eigen/SparseCholesky>

#include <cmath>
#include <utility>
#include <variant>

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

template <int Dim>
class DirectSolver final : public LinearSolver<Dim> {
public:
    LinearSolution<Dim> solve(const NewtonSystem<Dim>& system,
                              const BlockVector<Dim>& /*positions*/,
                              const LinearSolveOptions& /*options*/,
                              BlockVector<Dim> guess) override {
        const BlockVector<Dim>& b = system.right();
        LinearSolution<Dim> solution{std::move(guess), {}};
        LinearSolveReport& report = solution.report;
        const double b_norm = b.norm();
        const Sparse lower = std::visit(
            [](const auto& matrix) { return lower_triangle<Dim>(matrix); }, system.matrix());
        const Eigen::SimplicialLDLT<Sparse, Eigen::Lower> factors(lower);
        report.has_broken_down =
            factors.info() != Eigen::Success || !(factors.vectorD().minCoeff() > 0);
        if (report.has_broken_down || b_norm == 0) {
            solution.x.setZero();
            report.has_converged = !report.has_broken_down;
            return solution;
        }
        solution.x.reshaped() = factors.solve(b.reshaped());
        const Eigen::VectorXd left =
            b.reshaped() - lower.selfadjointView<Eigen::Lower>() * solution.x.reshaped();
        report.residual = left.norm() / b_norm;
        report.has_converged = std::isfinite(report.residual);
        return solution;
    }
};

}  // namespace

template <int Dim>
std::unique_ptr<LinearSolver<Dim>> make_direct_solver() {
    return std::make_unique<DirectSolver<Dim>>();
}

template std::unique_ptr<LinearSolver<3>> make_direct_solver();
template std::unique_ptr<LinearSolver<4>> make_direct_solver();

}  // namespace pent::simulator
