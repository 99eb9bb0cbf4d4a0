#include "linear/conjugate_gradients.h"
#include "linear/linear_solver.h"
#include "linear/preconditioner.h"

#include <pent/dimensions.h>

#include <numeric>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

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
                const BlockPattern* coupling =
                    matrix.coupling() != nullptr ? &matrix.coupling()->pattern() : nullptr;
                // Blocks of elements are always the same; what stencils couple changes.
                const bool has_coupling = any(coupling != nullptr);
                if (!has_coupling && !plain_) {
                    plain_ = surroundings_of(matrix.pattern(), nullptr);
                }
                Surroundings coupled;
                if (has_coupling) {
                    coupled = surroundings_of(matrix.pattern(), coupling);
                }
                const Surroundings& around = has_coupling ? coupled : *plain_;
                std::unique_ptr<Preconditioner<Dim>> preconditioner =
                    column_jacobi(*workers_, *kernels_, matrix, dofs_.column_start);
                if (around.hierarchy) {
                    preconditioner = multilevel(*workers_, *kernels_, matrix, *around.hierarchy,
                                                positions, std::move(preconditioner));
                }
                return iteration_.solve(matrix, *preconditioner, system.right(), options,
                                        std::move(guess),
                                        {dofs_.owners.sharing, around.exchange.get()});
            },
            system.matrix());
    }

private:
    // What hangs on which blocks a matrix has.
    struct Surroundings {
        std::unique_ptr<GhostExchange> exchange;  // null where dofs are not shared
        std::unique_ptr<Hierarchy> hierarchy;     // for rigid modes
    };

    [[nodiscard]] bool any(bool is_so) const {
        return dofs_.owners.sharing != nullptr ? dofs_.owners.sharing->any(is_so) : is_so;
    }

    Surroundings surroundings_of(const BlockPattern& pattern, const BlockPattern* coupling) {
        Surroundings around;
        Ghosts ghosts;
        if (dofs_.owners.sharing != nullptr) {
            ghosts = ghosts_of(pattern, coupling);
            around.exchange = dofs_.owners.sharing->ranks().make_exchange(ghosts);
        }
        if (kind_ == PreconditionerKind::RigidModes) {
            if (aggregates_.empty()) {
                aggregates_ = make_hierarchy<Dim>(pattern, dofs_.column_start, dofs_.rest,
                                                  dofs_.owners.sharing);
            }
            around.hierarchy = std::make_unique<Hierarchy>(
                aggregates_, pattern, coupling, Halo{dofs_.owners.sharing, around.exchange.get()},
                ghosts);
        }
        return around;
    }

    [[nodiscard]] Ghosts ghosts_of(const BlockPattern& pattern,
                                   const BlockPattern* coupling) const {
        Ghosts ghosts;
        ghosts.own_columns = static_cast<std::uint32_t>(pattern.rows());
        ghosts.columns = ghost_columns(pattern, coupling);
        for (const std::uint32_t ghost : ghosts.columns) {
            ghosts.owners.push_back(dofs_.owners.ranks[ghost]);
            ghosts.places.push_back(dofs_.owners.places[ghost]);
        }
        return ghosts;
    }

    const Workers* workers_;
    const BlockKernels* kernels_;
    PreconditionerKind kind_;
    DofGeometry<Dim> dofs_;               // with columns that are solved together
    std::vector<Aggregates> aggregates_;  // from the first solve on
    std::optional<Surroundings> plain_;   // from the first without a coupling on
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
