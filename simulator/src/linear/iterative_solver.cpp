#include "linear/aggregates.h"
#include "linear/conjugate_gradients.h"
#include "linear/linear_solver.h"
#include "linear/preconditioner.h"

#include <numeric>
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
          column_start_(std::move(geometry.column_start)) {
        if (kind_ == PreconditionerKind::BlockJacobi) {
            column_start_.resize(static_cast<std::size_t>(geometry.rest.cols()) + 1);
            std::iota(column_start_.begin(), column_start_.end(), 0U);
        }
        if (kind_ == PreconditionerKind::RigidModes) {
            aggregates_ = make_aggregates<Dim>(geometry.rest, geometry.bodies);
        }
    }

    LinearSolution<Dim> solve(const NewtonSystem<Dim>& system,
                              const BlockVector<Dim>& positions,
                              const LinearSolveOptions& options,
                              BlockVector<Dim> guess) override {
        LinearSolution<Dim> solution{std::move(guess), {}};
        solution.report = std::visit(
            [&](const auto& matrix) {
                const std::unique_ptr<Preconditioner<Dim>> preconditioner =
                    precondition(matrix, positions);
                return conjugate_gradients(*workers_, *kernels_, matrix, *preconditioner,
                                           system.right(), options, space_, solution.x);
            },
            system.matrix());
        return solution;
    }

private:
    template <typename Scalar>
    [[nodiscard]] std::unique_ptr<Preconditioner<Dim>> precondition(
        const BlockMatrix<Dim, Scalar>& matrix, const BlockVector<Dim>& positions) const {
        std::unique_ptr<Preconditioner<Dim>> smoother =
            column_jacobi(*workers_, matrix, column_start_);
        if (kind_ != PreconditionerKind::RigidModes) {
            return smoother;
        }
        return with_rigid_modes(*workers_, matrix, aggregates_, positions, std::move(smoother));
    }

    const Workers* workers_;
    const BlockKernels* kernels_;
    PreconditionerKind kind_;
    std::vector<std::uint32_t> column_start_;  // columns that are solved together
    Aggregates aggregates_;                    // for the coarse space, if there is one
    LinearSolveSpace<Dim> space_;
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
