#include "linear/conjugate_gradients.h"
#include "linear/elimination.h"
#include "linear/linear_solver.h"
#include "linear/preconditioner.h"

#include <pent/dimensions.h>

#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

namespace pent::simulator {

namespace {

// Cost model of iterations and of factorizations, in ns measured on small bodies; only ratios
// count.
constexpr double kIteration = 15'000;  // of an iteration, and
constexpr double kNumber = 0.25;       // for each number of the matrix
constexpr double kFactors = 100'000;   // of a factorization,
constexpr double kSupernode = 1200;    // for each supernode, and
constexpr double kProduct = 0.25;      // for each product of two numbers

// With fewer rows a factorization gains less than 0.1 ms; with more it is not considered, since it
// uses one thread only.
constexpr std::int64_t kFewestRows = 64;
constexpr std::int64_t kMostRows = 4096;

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
                // The pattern of elements never changes, that of couplings from solve to solve. All
                // ranks have to take the same branch, even those without a coupling of their own.
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
                const bool may_factor = kind_ == PreconditionerKind::RigidModes && !has_coupling
                                        && dofs_.owners.sharing == nullptr;
                LinearSolution<Dim> solution = iteration_.solve(
                    matrix, *preconditioner, system.right(), options, std::move(guess),
                    {dofs_.owners.sharing, around.exchange.get()}, [&] {
                        return may_factor ? cost_of_factors(matrix.pattern())
                                          : std::numeric_limits<double>::infinity();
                    });
                if (solution.report.is_slow) {
                    solution = finish(matrix, *preconditioner, system.right(), options,
                                      std::move(solution));
                }
                return solution;
            },
            system.matrix());
    }

private:
    // What depends on the pattern of a matrix, but not on its values.
    struct Surroundings {
        std::unique_ptr<GhostExchange> exchange;  // null without ranks
        std::unique_ptr<Hierarchy> hierarchy;     // null but for rigid modes
    };

    // What a factorization costs, in iterations, of a matrix without a coupling.
    [[nodiscard]] double cost_of_factors(const BlockPattern& pattern) {
        if (pattern.rows() < kFewestRows || pattern.rows() > kMostRows) {
            return std::numeric_limits<double>::infinity();
        }
        if (!elimination_) {
            elimination_ = eliminate(link_dofs(pattern), dofs_.rest);
        }
        const double products = Dim * Dim * Dim * elimination_->products;
        const auto numbers = static_cast<double>(Dim * Dim * pattern.blocks());
        return (kFactors + kSupernode * static_cast<double>(elimination_->supernodes.size())
                + kProduct * products)
               / (kIteration + kNumber * numbers);
    }

    // Factors the matrix and makes the last iteration with that; where rounding has made a pivot
    // negative, goes on with the preconditioner it had.
    template <typename Scalar>
    [[nodiscard]] LinearSolution<Dim> finish(const BlockMatrix<Dim, Scalar>& A,
                                             const Preconditioner<Dim>& fallback,
                                             const BlockVector<Dim>& b,
                                             LinearSolveOptions options,
                                             LinearSolution<Dim> so_far) {
        const auto exact = exact_inverse(*kernels_, A, *elimination_);
        options.max_iterations -= so_far.report.iterations;
        LinearSolution<Dim> solution =
            iteration_.solve(A, exact ? *exact : fallback, b, options, std::move(so_far.x));
        solution.report.iterations += so_far.report.iterations;
        return solution;
    }

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
    DofGeometry<Dim> dofs_;                   // for block Jacobi with columns of single dofs
    std::vector<Aggregates> aggregates_;      // made by the first solve, of the elements' pattern
    std::optional<Surroundings> plain_;       // made by the first solve without a coupling
    std::optional<Elimination> elimination_;  // made when a factorization is first considered
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
