#include "step/incremental_potential.h"

#include "model/body_dofs.h"

#include <pent/dimensions.h>
#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/simulator/step_failures.h>
#include <pent/stopwatch.h>

#include <algorithm>
#include <utility>

namespace pent::simulator {

namespace {

// The same dofs in the order of the rows of this rank; of one process alone the same map.
template <int Dim>
std::shared_ptr<const DofMap> rows_of(const std::shared_ptr<const DofMap>& alike,
                                      const Bodies<Dim>& bodies,
                                      const HeldVertices<Dim>& held,
                                      const std::vector<bool>& is_in) {
    return bodies.sharing.is_shared()
               ? std::make_shared<const DofMap>(number_dofs(bodies, held, is_in))
               : alike;
}

}  // namespace

template <int Dim>
IncrementalPotential<Dim>::IncrementalPotential(const Workers& workers,
                                                const Kernels<Dim>& kernels,
                                                const Bodies<Dim>& bodies,
                                                const HeldVertices<Dim>& held,
                                                const Scene& scene,
                                                SceneEnergy<Dim>& energy)
    : workers_(&workers),
      kernels_(&kernels),
      bodies_(&bodies),
      options_(scene.solver),
      damping_(scene.damping.value_or(Damping{})),
      energy_(&energy.sum),
      elasticity_(energy.elasticity),
      dofs_(std::make_shared<const DofMap>(
          number_dofs_alike(bodies, held, std::vector<bool>(bodies.count(), true)))),
      rows_(rows_of(dofs_, bodies, held, std::vector<bool>(bodies.count(), true))),
      scales_(bodies),
      range_(Dim, bodies.masses, bodies.ranges),
      inertia_(workers, dofs_, bodies.masses),
      mass_drag_(workers, dofs_, bodies.masses),
      stiffness_drag_(
          workers, kernels.blocks, *elasticity_, rows_, bodies.sharing, scene.solver.filter) {
    set_up_solver();
}

template <int Dim>
void IncrementalPotential<Dim>::refuse_unsolvable(std::int64_t memory) const {
    const bool is_direct = options_.linear == LinearSolverKind::Direct;
    if (is_direct && bodies_->sharing.is_shared()) {
        throw Error(
            "solver.linear = \"direct\" is for one process: use \"cg\", or run the scene by"
            " pent-sim");
    }
    constexpr double kMegabyte = 1e6;
    const std::int64_t wanted = factor_bytes();
    if (memory > 0 && wanted > memory) {
        throw Error("solver.linear = \"direct\" needs "
                    + formatted("%.3g MB for %u free vertices, of %.3g MB",
                                static_cast<double>(wanted) / kMegabyte, dofs_->count(),
                                static_cast<double>(memory) / kMegabyte)
                    + " that there are: use \"cg\"");
    }
}

template <int Dim>
void IncrementalPotential<Dim>::renumber(const HeldVertices<Dim>& held,
                                         const std::vector<bool>& asleep,
                                         const Positions<Dim>& positions) {
    std::vector<bool> awake = asleep;
    awake.flip();
    dofs_ = std::make_shared<const DofMap>(number_dofs_alike(*bodies_, held, awake));
    rows_ = rows_of(dofs_, *bodies_, held, awake);
    elasticity_->set_dofs(*rows_, held, asleep, positions);
    energy_->invalidate();
    inertia_.set_dofs(dofs_);
    mass_drag_.set_dofs(dofs_);
    stiffness_drag_.set_dofs(rows_);
    set_up_solver();
}

// Which rank owns each dof of the matrix, and its place there.
template <int Dim>
DofOwners IncrementalPotential<Dim>::find_owners() const {
    const Sharing& sharing = bodies_->sharing;
    if (!sharing.is_shared()) {
        return {};
    }
    Eigen::Matrix<double, 1, Eigen::Dynamic> places =
        Eigen::RowVectorXd::Zero(bodies_->vertex_count());
    for (std::uint32_t dof = 0; dof < rows_->row_count(); ++dof) {
        places[rows_->vertex_of(dof)] = dof;
    }
    sharing.gather(places);
    DofOwners owners;
    owners.sharing = &sharing;
    for (const std::uint32_t vertex : rows_->vertices()) {
        owners.ranks.push_back(sharing.owner(vertex));
        owners.places.push_back(static_cast<std::uint32_t>(places[vertex]));
    }
    return owners;
}

template <int Dim>
void IncrementalPotential<Dim>::set_up_solver() {
    if (options_.linear == LinearSolverKind::Direct) {
        solver_ = make_direct_solver<Dim>(kernels_->blocks, at_dofs(*rows_, bodies_->rest()));
    } else {
        solver_ = make_iterative_solver<Dim>(
            *workers_, kernels_->blocks, options_.preconditioner,
            DofGeometry<Dim>{rows_->column_start(), at_dofs(*rows_, bodies_->rest()),
                             find_owners()});
    }
    float_system_.reset();
    double_system_.reset();
    pattern_ = elasticity_->pattern();
    auto& system = options_.precision == Precision::Float ? float_system_ : double_system_;
    system = std::make_unique<NewtonSystem<Dim>>(*workers_, *rows_, *pattern_, options_.precision);
}

template <int Dim>
void IncrementalPotential<Dim>::begin_step(std::shared_ptr<const StepProblem<Dim>> problem,
                                           const StepStart<Dim>& start) {
    problem_ = std::move(problem);
    scales_.set_inertia(problem_->inertia != 0);
    inertia_.set_anchor({problem_, &problem_->target});
    mass_drag_.set_anchor({problem_, &problem_->origin});
    energy_->begin_step(start);
    elasticity_->set_hessian_factor(1);
    if (damping_.stiffness > 0) {
        static_cast<void>(stiffness_drag_.begin_step(start));
        if (!stiffness_drag_.has_tangent()) {
            elasticity_->set_hessian_factor(1 + problem_->rate * damping_.stiffness);
        }
    }
}

template <int Dim>
void IncrementalPotential<Dim>::balance(const Positions<Dim>& x) {
    for (const auto& term : energy_->terms()) {
        if (!term->wants_balance()) {
            continue;
        }
        const Evaluation<Dim> all = evaluate(x);
        const Positions<Dim> own = problem_->scale * energy_->gradient_of(*term);
        if (term->balance(at_dofs<Dim>(*dofs_, own), at_dofs<Dim>(*dofs_, all.gradient - own))) {
            energy_->invalidate();
        }
    }
}

template <int Dim>
Evaluation<Dim> IncrementalPotential<Dim>::evaluate(const Positions<Dim>& x) {
    energy_->update(x);
    Evaluation<Dim> at;
    at.value = problem_->scale * energy_->value();
    at.rounding = problem_->scale * energy_->rounding();
    at.has_kink = energy_->has_kink();
    at.gradient.setZero(Dim, x.cols());
    Positions<Dim> part;
    const auto add = [&](double weight, Potential<Dim>& term) {
        if (weight != 0) {
            part.setZero(Dim, x.cols());
            at.value += weight * term.evaluate(x, part);
            at.gradient += weight * part;
        }
    };
    const double drag = problem_->scale * problem_->rate;
    add(problem_->inertia, inertia_);
    add(drag * damping_.mass, mass_drag_);
    at.gradient += problem_->scale * energy_->gradient();
    add(drag * damping_.stiffness, stiffness_drag_);
    for (std::uint32_t vertex = 0; vertex < dofs_->vertex_count(); ++vertex) {
        if (!dofs_->has_dof(vertex)) {
            at.gradient.col(vertex).setZero();
        }
    }
    return at;
}

template <int Dim>
Positions<Dim> IncrementalPotential<Dim>::prescribed_displacement(const Positions<Dim>& x) const {
    Positions<Dim> displacement = Positions<Dim>::Zero(Dim, x.cols());
    const PrescribedPlaces<Dim>& prescribed = problem_->prescribed;
    prescribed.put_into(displacement);
    for (const std::uint32_t vertex : prescribed.vertices) {
        displacement.col(vertex) -= x.col(vertex);
    }
    return displacement;
}

template <int Dim>
bool IncrementalPotential<Dim>::accept(const Positions<Dim>& x) {
    if (observer_) {
        observer_(x, false);
    }
    return energy_->adapt();
}

template <int Dim>
void IncrementalPotential<Dim>::tell_start(const Positions<Dim>& x) const {
    if (observer_) {
        observer_(x, true);
    }
}

// Returns false where the matrix is of no use, as the masses have been lost in its rounding.
template <int Dim>
bool IncrementalPotential<Dim>::assemble(NewtonSystem<Dim>& system,
                                         Filter filter,
                                         const Positions<Dim>& gradient,
                                         const Positions<Dim>& displacement) {
    const Stopwatch watch;
    const Positions<Dim>& x = energy_->positions();
    // To scale by a power of two is exact, and to scale a whole equation leaves its solution.
    const double part = 1 / range_.unit(problem_->inertia, problem_->scale);
    system.begin(-part * at_dofs(*rows_, gradient), displacement);
    double others = 0;  // seconds, which terms count themselves
    for (const auto& term : energy_->terms()) {
        const Stopwatch own;
        term->add_hessian(x, part * problem_->scale, filter, system);
        others += term.get() == elasticity_ ? 0 : own.seconds();
    }
    const double drag = part * problem_->scale * problem_->rate;
    if (problem_->inertia != 0) {
        inertia_.add_hessian(x, part * problem_->inertia, filter, system);
    }
    if (drag * damping_.mass != 0) {
        mass_drag_.add_hessian(x, drag * damping_.mass, filter, system);
    }
    if (drag * damping_.stiffness != 0) {
        stiffness_drag_.add_hessian(x, drag * damping_.stiffness, filter, system);
    }
    system.weigh_masses();
    work_.assembly_seconds += watch.seconds() - others;
    const bool has_lost_inertia = bodies_->sharing.any(system.has_lost_inertia());
    if (has_lost_inertia && !(may_be_rough_ && &system == double_system_.get())) {
        return false;
    }
    const Stopwatch summing;
    system.finish();
    work_.stencil_seconds += summing.seconds();
    return true;
}

// In float, or in double where float does not hold the numbers or masses would be lost in its
// rounding; null if they are lost in double, too. Which of the two is tried first saves time and
// does not change the result.
template <int Dim>
NewtonSystem<Dim>* IncrementalPotential<Dim>::assemble_somehow(Filter filter,
                                                               const Positions<Dim>& gradient,
                                                               const Positions<Dim>& displacement) {
    const auto is_float_enough = [&] {
        return float_system_ && range_.is_in_float(problem_->inertia, problem_->scale)
               && assemble(*float_system_, filter, gradient, displacement);
    };
    const bool is_float_first = !was_double_needed_;
    if (is_float_first && is_float_enough()) {
        return float_system_.get();
    }
    if (!double_system_) {
        double_system_ =
            std::make_unique<NewtonSystem<Dim>>(*workers_, *rows_, *pattern_, Precision::Double);
    }
    const bool is_assembled = assemble(*double_system_, filter, gradient, displacement);
    was_double_needed_ = bodies_->sharing.any(double_system_->needs_double());
    if (!is_float_first && !was_double_needed_ && is_float_enough()) {
        return float_system_.get();
    }
    return is_assembled ? double_system_.get() : nullptr;
}

template <int Dim>
LinearSolution<Dim> IncrementalPotential<Dim>::solve_filtered(const NewtonSystem<Dim>& system,
                                                              double tolerance) {
    const Stopwatch watch;
    const LinearSolveOptions options{.tolerance = std::max(tolerance, options_.tolerance),
                                     .max_iterations = options_.max_iterations,
                                     .weights = scales_.weights(*rows_)};
    const Positions<Dim>& x = energy_->positions();
    // A single linear solve has the whole step to find: most of it is what inertia alone would do.
    BlockVector<Dim> guess = tolerance == 0
                                 ? at_dofs<Dim>(*rows_, problem_->target - x)
                                 : BlockVector<Dim>(BlockVector<Dim>::Zero(Dim, rows_->count()));
    LinearSolution<Dim> solution =
        solver_->solve(system, at_dofs(*rows_, x), options, std::move(guess));
    work_.solve_seconds += watch.seconds();
    work_.iterations += solution.report.iterations;
    return solution;
}

template <int Dim>
NewtonDirection<Dim> IncrementalPotential<Dim>::solve(const Positions<Dim>& gradient,
                                                      const Positions<Dim>& displacement,
                                                      double tolerance) {
    if (dofs_->count() == 0) {  // all bodies sleep, or move from outside alone
        return {displacement, ""};
    }
    NewtonDirection<Dim> direction;
    LinearSolution<Dim> solution;
    // Clamped, the matrix is positive definite whatever the scene asks for.
    for (const Filter filter : {options_.filter, Filter::Clamp}) {
        NewtonSystem<Dim>* system = assemble_somehow(filter, gradient, displacement);
        if (system == nullptr) {
            direction.failure_reason =
                "the stiffness drowns the inertia; take smaller steps, softer or denser bodies, or"
                " thicker cells";
            return direction;
        }
        // Only the matrix that is solved with counts, so that reports do not depend on which
        // precision was tried first.
        work_.hessians += elasticity_->element_count();
        work_.filtered += elasticity_->filtered();
        work_.unknowns += std::int64_t{Dim} * dofs_->count();
        solution = solve_filtered(*system, tolerance);
        if (!solution.report.has_broken_down || filter == Filter::Clamp) {
            break;
        }
    }
    work_.residual = std::max(work_.residual, solution.report.residual);
    const bool is_usable =
        solution.report.has_converged || (may_be_rough_ && !solution.report.has_broken_down);
    if (!is_usable) {
        direction.failure_reason =
            solution.report.has_broken_down ? kIndefiniteFailure : kSolverFailure;
        return direction;
    }
    direction.step = displacement;
    for (std::uint32_t dof = 0; dof < rows_->row_count(); ++dof) {
        direction.step.col(rows_->vertex_of(dof)) = solution.x.col(dof);
    }
    bodies_->sharing.gather(direction.step);
    return direction;
}

template <int Dim>
std::int64_t IncrementalPotential<Dim>::bytes_per_block() const {
    constexpr std::int64_t kEntries = std::int64_t{Dim} * Dim;
    const std::int64_t scalar = (float_system_ ? sizeof(float) : 0)  //
                                + (double_system_ ? sizeof(double) : 0);
    return kEntries * scalar + static_cast<std::int64_t>(sizeof(std::uint32_t));
}

template <int Dim>
std::int64_t IncrementalPotential<Dim>::tangent_bytes() const {
    constexpr std::int64_t kEntries = std::int64_t{Dim} * Dim;
    return stiffness_drag_.tangent_blocks() * kEntries * static_cast<std::int64_t>(sizeof(double));
}

template <int Dim>
std::int64_t IncrementalPotential<Dim>::factor_bytes() const {
    return options_.linear == LinearSolverKind::Direct
               ? direct_bytes<Dim>(*pattern_, at_dofs(*rows_, bodies_->rest()))
               : 0;
}

#define PENT_INSTANTIATE(Dim) template class IncrementalPotential<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
