#include "linear/conjugate_gradients.h"
#include "linear/linear_solver.h"
#include "linear/preconditioner.h"

#include <numeric>
#include <optional>
#include <utility>
#include <variant>

namespace pent::simulator {

namespace {

template <int Dim>
class IterativeSolver final : public LinearSolver<Dim> {
public:
    IterativeSolver(const Workers& workers,
                    const BlockKernels& kernels,
                    PreconditionerKind preconditioner,
                    DofGeometry<Dim> geometry)
        : workers_(&workers),
          kernels_(&kernels),
          kind_(preconditioner),
          column_start_(std::move(geometry.column_start)),
          rest_(std::move(geometry.rest)),
          iteration_(workers, kernels) {
        if (kind_ == PreconditionerKind::BlockJacobi) {
            column_start_.resize(static_cast<std::size_t>(rest_.cols()) + 1);
            std::iota(column_start_.begin(), column_start_.end(), 0U);
        }
    }

    LinearSolution<Dim> solve(const NewtonSystem<Dim>& system,
                              const BlockVector<Dim>& positions,
                              const LinearSolveOptions& options,
                              BlockVector<Dim> guess) override {
        return std::visit(
            [&](const auto& matrix) {
                const std::unique_ptr<Preconditioner<Dim>> preconditioner =
                    precondition(matrix, positions);
                return iteration_.solve(matrix, *preconditioner, system.right(), options,
                                        std::move(guess));
            },
            system.matrix());
    }

private:
    template <typename Scalar>
    [[nodiscard]] std::unique_ptr<Preconditioner<Dim>> precondition(
        const BlockMatrix<Dim, Scalar>& matrix, const BlockVector<Dim>& positions) {
        std::unique_ptr<Preconditioner<Dim>> smoother =
            column_jacobi(*workers_, matrix, column_start_);
        if (kind_ != PreconditionerKind::RigidModes || matrix.rows() == 0) {
            return smoother;
        }
        if (!hierarchy_) {
            const BlockPattern& pattern = matrix.pattern();
            hierarchy_.emplace(make_hierarchy<Dim>(pattern, column_start_, rest_), pattern);
        }
        return multilevel(*workers_, *kernels_, matrix, *hierarchy_, positions,
                          std::move(smoother));
    }

    const Workers* workers_;
    const BlockKernels* kernels_;
    PreconditionerKind kind_;
    std::vector<std::uint32_t> column_start_;  // columns that are solved together
    BlockVector<Dim> rest_;
    std::optional<Hierarchy> hierarchy_;  // of the dofs, from the first solve on
    ConjugateGradients<Dim> iteration_;
};

}  // namespace

template <int Dim>
std::unique_ptr<LinearSolver<Dim>> make_iterative_solver(const Workers& workers,
                                                         const BlockKernels& kernels,
                                                         PreconditionerKind preconditioner,
                                                         DofGeometry<Dim> geometry) {
    return std::make_unique<IterativeSolver<Dim>>(workers, kernels, preconditioner,
                                                  std::move(geometry));
}

template std::unique_ptr<LinearSolver<3>> make_iterative_solver(const Workers&,
                                                                const BlockKernels&,
                                                                PreconditionerKind,
                                                                DofGeometry<3>);
template std::unique_ptr<LinearSolver<4>> make_iterative_solver(const Workers&,
                                                                const BlockKernels&,
                                                                PreconditionerKind,
                                                                DofGeometry<4>);

}  // namespace pent::simulator
