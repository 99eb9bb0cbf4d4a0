#include "step_problem.h"

#include <algorithm>
#include <cmath>

namespace pent::simulator {

namespace {

constexpr int kMostIterations = 50;
constexpr int kMostBacktracks = 30;
// Where a vertex lies in a valley between two facets of another body, phi has a kink: its lowest point
// is where the forces of both facets would have to act at once. Newton's method is there when a step
// that had to be cut gains less than this part of what all of them have, and the force left over is
// below this part of that at the start.
constexpr double kKinkGain = 1e-4;
constexpr double kKinkForce = 0.05;
// The linear solves of Newton's method need not be more exact than this: each iteration then gains
// two digits, which is what its quadratic model is good for.
constexpr double kForcing = 1e-2;
// Least part of the decrease that the slope promises for a step to be taken [nocedal2006, 3.1].
constexpr double kArmijo = 1e-4;

// Held vertices at the end of the step minus where they are in x; zero for free ones.
template <int Dim>
Positions<Dim> held_shift(const World<Dim>& world,
                          const StepProblem<Dim>& problem,
                          const Positions<Dim>& x) {
    Positions<Dim> shift = Positions<Dim>::Zero(Dim, x.cols());
    for (const HeldSet<Dim>& held : world.held) {
        for (const std::uint32_t vertex : held.vertices) {
            shift.col(vertex) = problem.held.col(vertex) - x.col(vertex);
        }
    }
    return shift;
}

template <int Dim>
struct Potential {
    double value = 0;
    BlockVector<Dim> gradient;  // Dim x unknowns
};

// phi at a state whose forces and energies are up to date.
template <int Dim>
Potential<Dim> potential(const System<Dim>& system,
                         const World<Dim>& world,
                         const StepProblem<Dim>& problem,
                         const BodyState<Dim>& state) {
    const Numbering& numbering = world.numbering;
    const Damping damping = system.damping();
    const double drag = problem.scale * problem.rate * damping.mass;
    const Energies& energies = state.energies;
    Potential<Dim> phi;
    phi.value = problem.scale
                * (energies.elastic + energies.gravity + energies.obstacle + energies.contact);
    phi.gradient.resize(Dim, numbering.free_count());
    BlockVector<Dim> travel(Dim, numbering.free_count());
    for (std::uint32_t unknown = 0; unknown < numbering.free_count(); ++unknown) {
        const std::uint32_t vertex = numbering.vertex_of_unknown[unknown];
        const double mass = world.masses[vertex];
        const Vector<Dim> lag = state.positions.col(vertex) - problem.target.col(vertex);
        travel.col(unknown) = state.positions.col(vertex) - problem.origin.col(vertex);
        phi.value +=
            0.5 * mass
            * (problem.inertia * lag.squaredNorm() + drag * travel.col(unknown).squaredNorm());
        phi.gradient.col(unknown) = problem.inertia * mass * lag + drag * mass * travel.col(unknown)
                                    - problem.scale * state.forces.col(vertex);
    }
    if (damping.stiffness > 0) {
        const double factor = problem.scale * problem.rate * damping.stiffness;
        const BlockVector<Dim> resistance = system.damping_product(travel);
        phi.gradient += factor * (resistance + system.held_damping());
        phi.value += factor
                     * (0.5 * resistance.cwiseProduct(travel).sum()
                        + system.held_damping().cwiseProduct(travel).sum());
    }
    return phi;
}

// Sufficient decrease of phi along a direction of this slope.
template <int Dim>
bool has_improved(const Potential<Dim>& phi,
                  const Potential<Dim>& next,
                  double factor,
                  double slope) {
    constexpr double kRounding = 1e-13;  // of phi
    return next.value <= phi.value + kArmijo * factor * slope + kRounding * std::abs(phi.value);
}

// Sufficient decrease of the unbalanced force. What views take from mixed pairs in contact is held, so
// their forces are not quite the derivative of phi, and near balance phi alone may rise.
template <int Dim>
bool has_less_force(const Potential<Dim>& phi, const Potential<Dim>& next, double factor) {
    return next.gradient.norm() <= (1 - kArmijo * factor) * phi.gradient.norm();
}

template <int Dim>
void add_to_free(const World<Dim>& world,
                 double factor,
                 const BlockVector<Dim>& dx,
                 Positions<Dim>& x) {
    for (std::uint32_t unknown = 0; unknown < world.numbering.free_count(); ++unknown) {
        x.col(world.numbering.vertex_of_unknown[unknown]) += factor * dx.col(unknown);
    }
}

bool has_solved(const LinearSolveReport& solved, StepReport& report) {
    if (!solved.has_converged) {
        report.failure = solved.has_broken_down ? "the matrix was not positive definite"
                                                : "the linear solver did not reach its tolerance";
    }
    return solved.has_converged;
}

}  // namespace

template <int Dim>
bool take_linear_step(System<Dim>& system,
                      const World<Dim>& world,
                      const StepProblem<Dim>& problem,
                      const BodyState<Dim>& now,
                      Positions<Dim>& x,
                      StepReport& report) {
    const Numbering& numbering = world.numbering;
    const Damping damping = system.damping();
    LinearStep<Dim> step;
    step.mass_factor = problem.inertia + problem.scale * problem.rate * damping.mass;
    step.elastic_factor = problem.scale * (1 + problem.rate * damping.stiffness);
    step.contact_factor = problem.scale;
    step.held_shift = held_shift(world, problem, now.positions);
    step.right.resize(Dim, numbering.free_count());
    BlockVector<Dim> dx(Dim, numbering.free_count());
    for (std::uint32_t unknown = 0; unknown < numbering.free_count(); ++unknown) {
        const std::uint32_t vertex = numbering.vertex_of_unknown[unknown];
        const Vector<Dim> ahead = problem.target.col(vertex) - now.positions.col(vertex);
        const Vector<Dim> drag =
            damping.mass * problem.rate * (problem.origin.col(vertex) - now.positions.col(vertex));
        step.right.col(unknown) =
            world.masses[vertex] * (problem.inertia * ahead + problem.scale * drag)
            + problem.scale * now.forces.col(vertex);
        dx.col(unknown) = ahead;  // a first guess
    }
    x = now.positions;
    if (dx.cols() > 0) {
        if (!has_solved(system.solve(now, step, dx, report), report)) {
            return false;
        }
        add_to_free(world, 1, dx, x);
    }
    x += step.held_shift;
    return true;
}

template <int Dim>
bool minimize(System<Dim>& system,
              const World<Dim>& world,
              const StepProblem<Dim>& problem,
              const BodyState<Dim>& now,
              double extent,
              BodyState<Dim>& state,
              StepReport& report) {
    constexpr double kNegligible = 1e-10;  // of the scene, for a correction
    const Damping damping = system.damping();
    if (damping.stiffness > 0) {
        system.set_damping_tangent(now.positions, held_shift(world, problem, problem.origin));
    }
    state.velocities = now.velocities;  // kinetic energy plays no part in phi
    state.positions = now.positions + held_shift(world, problem, now.positions);
    system.evaluate(state);
    const Potential<Dim> begin = potential(system, world, problem, state);
    const double start = begin.gradient.norm();
    if (!take_linear_step(system, world, problem, now, state.positions, report)) {
        return false;
    }
    system.evaluate(state);
    Potential<Dim> phi = potential(system, world, problem, state);
    BodyState<Dim> trial = state;
    for (int iteration = 0; iteration < kMostIterations; ++iteration) {
        if (!std::isfinite(phi.value)) {
            report.failure = "the energy grew beyond all bounds";
            return false;
        }
        if (phi.gradient.norm() <= system.options().newton_tolerance * start) {
            report.unbalanced = std::max(report.unbalanced, phi.gradient.norm() / start);
            return true;
        }
        ++report.newton_iterations;
        LinearStep<Dim> step;
        step.mass_factor = problem.inertia + problem.scale * problem.rate * damping.mass;
        step.elastic_factor = problem.scale;
        step.contact_factor = problem.scale;
        step.damping_factor = problem.scale * problem.rate * damping.stiffness;
        step.held_shift.setZero(Dim, state.positions.cols());
        step.right = -phi.gradient;
        step.tolerance = kForcing;
        BlockVector<Dim> dx = BlockVector<Dim>::Zero(Dim, phi.gradient.cols());
        if (!has_solved(system.solve(state, step, dx, report), report)) {
            return false;
        }
        if (dx.cwiseAbs().maxCoeff() < kNegligible * extent) {
            return true;
        }
        const double slope = phi.gradient.cwiseProduct(dx).sum();
        const double before = phi.value;
        double factor = 1;
        bool is_taken = false;
        for (int k = 0; k < kMostBacktracks && !is_taken; ++k, factor /= 2) {
            trial.positions = state.positions;
            add_to_free(world, factor, dx, trial.positions);
            system.evaluate(trial);
            Potential<Dim> next = potential(system, world, problem, trial);
            is_taken = has_improved(phi, next, factor, slope)
                       || (trial.energies.contact > 0 && has_less_force(phi, next, factor));
            if (is_taken) {
                std::swap(state, trial);
                phi = std::move(next);
            }
        }
        const bool is_cut =
            !is_taken || factor < 0.5;  // it was halved once more behind the last trial
        if (is_cut && state.energies.contact > 0
            && before - phi.value <= kKinkGain * (begin.value - phi.value)
            && phi.gradient.norm() <= kKinkForce * start) {
            report.unbalanced = std::max(report.unbalanced, phi.gradient.norm() / start);
            return true;
        }
        if (!is_taken) {
            report.failure = "the line search found no decrease";
            return false;
        }
    }
    report.failure = "Newton's method did not reach its tolerance";
    return false;
}

#define PENT_INSTANTIATE(Dim)                                                                \
    template bool take_linear_step(System<Dim>&, const World<Dim>&, const StepProblem<Dim>&, \
                                   const BodyState<Dim>&, Positions<Dim>&, StepReport&);     \
    template bool minimize(System<Dim>&, const World<Dim>&, const StepProblem<Dim>&,         \
                           const BodyState<Dim>&, double, BodyState<Dim>&, StepReport&);
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
