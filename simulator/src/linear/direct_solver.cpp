#include "linear/factorization.h"
#include "linear/linear_solver.h"

#include <pent/dimensions.h>

#include <cmath>
#include <optional>
#include <utility>
#include <variant>

namespace pent::simulator {

namespace {

// residual -= A x, in double, both triangles of A.
template <int Dim, typename Scalar>
void subtract_product(const BlockMatrix<Dim, Scalar>& A,
                      const BlockVector<Dim>& x,
                      BlockVector<Dim>& residual) {
    const BlockPattern& pattern = A.pattern();
    for (std::int64_t row = 0; row < A.rows(); ++row) {
        const auto r = static_cast<std::size_t>(row);
        for (std::int64_t k = pattern.row_start[r]; k < pattern.row_start[r + 1]; ++k) {
            const auto column = pattern.columns[static_cast<std::size_t>(k)];
            const Eigen::Matrix<double, Dim, Dim> block = A.compensated_block(row, k);
            residual.col(row) -= block * x.col(column);
            if (column != row) {
                residual.col(column) -= block.transpose() * x.col(row);
            }
        }
    }
}

template <int Dim>
class DirectSolver final : public LinearSolver<Dim> {
public:
    DirectSolver(const BlockKernels& kernels, BlockVector<Dim> rest)
        : kernels_(&kernels), rest_(std::move(rest)) {}

    LinearSolution<Dim> solve(const NewtonSystem<Dim>& system,
                              const BlockVector<Dim>& /*positions*/,
                              const LinearSolveOptions& /*options*/,
                              BlockVector<Dim> guess) override {
        return std::visit(
            [&](const auto& matrix) {
                return solve_matrix(matrix, system.right(), std::move(guess));
            },
            system.matrix());
    }

private:
    template <typename Scalar>
    [[nodiscard]] LinearSolution<Dim> solve_matrix(const BlockMatrix<Dim, Scalar>& A,
                                                   const BlockVector<Dim>& b,
                                                   BlockVector<Dim> guess) {
        LinearSolution<Dim> solution{std::move(guess), {}};
        LinearSolveReport& report = solution.report;
        std::optional<Elimination> coupled;
        if (A.coupling() != nullptr) {  // contacts change from solve to solve
            coupled =
                eliminate(join(link_dofs(A.pattern()), link_dofs(A.coupling()->pattern())), rest_);
        } else if (!plain_) {
            plain_ = eliminate(link_dofs(A.pattern()), rest_);
        }
        const auto factors = Factorization<Dim>::make(*kernels_, A, coupled ? *coupled : *plain_);
        report.has_broken_down = !factors;
        const double b_norm = b.norm();
        if (!factors || b_norm == 0) {
            solution.x.setZero();
            report.has_converged = !report.has_broken_down;
            return solution;
        }
        solution.x = factors->solve(b);
        BlockVector<Dim> left = b;
        subtract_product(A, solution.x, left);
        if (A.coupling() != nullptr) {
            subtract_product(*A.coupling(), solution.x, left);
        }
        report.residual = left.norm() / b_norm;
        report.has_converged = std::isfinite(report.residual);
        return solution;
    }

    const BlockKernels* kernels_;
    BlockVector<Dim> rest_;
    std::optional<Elimination> plain_;  // without a coupling; made by the first such solve
};

}  // namespace

template <int Dim>
std::unique_ptr<LinearSolver<Dim>> make_direct_solver(const BlockKernels& kernels,
                                                      BlockVector<Dim> rest) {
    return std::make_unique<DirectSolver<Dim>>(kernels, std::move(rest));
}

template <int Dim>
std::int64_t direct_bytes(const BlockPattern& pattern, const BlockVector<Dim>& rest) {
    return eliminate(link_dofs(pattern), rest).peak_blocks * Dim * Dim
           * static_cast<std::int64_t>(sizeof(double));
}

#define PENT_INSTANTIATE(Dim)                                                           \
    template std::unique_ptr<LinearSolver<Dim>> make_direct_solver(const BlockKernels&, \
                                                                   BlockVector<Dim>);   \
    template std::int64_t direct_bytes(const BlockPattern&, const BlockVector<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
