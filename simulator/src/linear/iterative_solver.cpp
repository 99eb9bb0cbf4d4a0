#include "linear/conjugate_gradients.h"
#include "linear/linear_solver.h"
#include "linear/preconditioner.h"
#include "linear/spread_modes.h"

#include <pent/dimensions.h>

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
          dofs_(std::move(geometry)),
          iteration_(workers, kernels) {
        if (kind_ == PreconditionerKind::BlockJacobi) {
            dofs_.column_start.resize(dofs_.column_start.back() + std::size_t{1});
            std::iota(dofs_.column_start.begin(), dofs_.column_start.end(), 0U);
        }
    }

    LinearSolution<Dim> solve(const NewtonSystem<Dim>& system,
                              const BlockVector<Dim>& positions,
                              const LinearSolveOptions& options,
                              BlockVector<Dim> guess) override {
        return std::visit(
            [&](const auto& matrix) {
                if (dofs_.owners.sharing != nullptr) {
                    find_ghosts(matrix);
                }
                const std::unique_ptr<Preconditioner<Dim>> preconditioner =
                    precondition(matrix, positions);
                return iteration_.solve(matrix, *preconditioner, system.right(), options,
                                        std::move(guess), {dofs_.owners.sharing, exchange_.get()});
            },
            system.matrix());
    }

private:
    template <typename Scalar>
    [[nodiscard]] std::unique_ptr<Preconditioner<Dim>> precondition(
        const BlockMatrix<Dim, Scalar>& matrix, const BlockVector<Dim>& positions) {
        std::unique_ptr<Preconditioner<Dim>> smoother =
            column_jacobi(*workers_, matrix, dofs_.column_start);
        if (kind_ != PreconditionerKind::RigidModes) {
            return smoother;
        }
        const BlockPattern& pattern = matrix.pattern();
        if (dofs_.owners.sharing != nullptr) {
            if (!spread_modes_) {
                spread_modes_.emplace(pattern, dofs_);
            }
            return spread_modes_->precondition(*workers_, matrix, positions, ghosts_, *exchange_,
                                               std::move(smoother));
        }
        if (matrix.rows() == 0) {
            return smoother;
        }
        if (!hierarchy_) {
            hierarchy_.emplace(make_hierarchy<Dim>(pattern, dofs_.column_start, dofs_.rest),
                               pattern);
        }
        return multilevel(*workers_, *kernels_, matrix, *hierarchy_, positions,
                          std::move(smoother));
    }

    // Those of elements are always the same; what stencils couple changes.
    template <typename Scalar>
    void find_ghosts(const BlockMatrix<Dim, Scalar>& matrix) {
        const bool has_coupling = dofs_.owners.sharing->any(matrix.coupling() != nullptr);
        if (exchange_ && !has_coupling && !had_coupling_) {
            return;
        }
        had_coupling_ = has_coupling;
        ghosts_ =
            ghost_columns(matrix.pattern(),
                          matrix.coupling() != nullptr ? &matrix.coupling()->pattern() : nullptr);
        Ghosts ghosts;
        ghosts.own_columns = static_cast<std::uint32_t>(matrix.rows());
        ghosts.columns = ghosts_;
        for (const std::uint32_t ghost : ghosts_) {
            ghosts.owners.push_back(dofs_.owners.ranks[ghost]);
            ghosts.places.push_back(dofs_.owners.places[ghost]);
        }
        exchange_ = dofs_.owners.sharing->ranks().make_exchange(ghosts);
    }

    const Workers* workers_;
    const BlockKernels* kernels_;
    PreconditionerKind kind_;
    DofGeometry<Dim> dofs_;  // with columns that are solved together
    // From the first solve on:
    std::optional<Hierarchy> hierarchy_;            // of the dofs
    std::optional<SpreadModes<Dim>> spread_modes_;  // the same, where dofs are shared
    std::vector<std::uint32_t> ghosts_;
    std::unique_ptr<GhostExchange> exchange_;
    bool had_coupling_ = false;
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

#define PENT_INSTANTIATE(Dim)                                          \
    template std::unique_ptr<LinearSolver<Dim>> make_iterative_solver( \
        const Workers&, const BlockKernels&, PreconditionerKind, DofGeometry<Dim>);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
