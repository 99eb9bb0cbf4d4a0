#include "potential.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pent::simulator {

namespace {

constexpr int kMostIterations = 50;
constexpr int kMostBacktracks = 30;
// Where a vertex lies in a valley between two facets of another body, phi has a kink: its lowest point
// is where the forces of both facets would have to act at once. Newton's method is there when the force
// left over is below this part of that at the start, and either a step that had to be cut gains less
// than this part of what all of them have, or the force has not become less in so many iterations.
constexpr double kKinkForce = 0.1;
constexpr double kKinkGain = 1e-4;
constexpr int kKinkIterations = 8;

// The share of mixed pairs in contact is held, so their forces are not quite the derivative of phi. Where
// the force becomes less, phi may therefore rise, by this part of what it has fallen so far.
constexpr double kMostRise = 1e-2;

// The state with the least unbalanced force that Newton's method has come by.
template <int Dim>
struct Best {
    BodyState<Dim> state;
    double force = std::numeric_limits<double>::infinity();
    int age = 0;  // iterations since

    void see(const BodyState<Dim>& now, double now_force) {
        ++age;
        if (now_force < force) {
            state = now;
            force = now_force;
            age = 0;
        }
    }
};

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
    const Damping damping = system.damping();
    if (damping.stiffness > 0) {
        system.set_damping_tangent(now.positions, held_shift(world, problem, problem.origin),
                                   report);
    }
    if (system.contacts().has_barrier()) {
        return minimize_without_crossing(system, world, problem, now, extent, state, report);
    }
    state.velocities = now.velocities;  // kinetic energy plays no part in phi
    state.positions = now.positions + held_shift(world, problem, now.positions);
    system.evaluate(state);
    const Potential<Dim> begin = potential(system, world, problem, state);
    const double start = begin.gradient.norm();
    BodyState<Dim> trial = state;
    if (!take_linear_step(system, world, problem, now, trial.positions, report)) {
        return false;
    }
    system.evaluate(trial);
    Potential<Dim> phi = potential(system, world, problem, trial);
    if (phi.value <= begin.value) {
        std::swap(state, trial);
    } else {
        phi = begin;  // the linear step has gone too far; searches along lines begin where all is
    }
    Best<Dim> best;  // kept in contact alone
    const auto is_at_kink = [&] {
        if (best.force > kKinkForce * start) {
            return false;
        }
        std::swap(state, best.state);
        report.unbalanced = std::max(report.unbalanced, best.force / start);
        return true;
    };
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
        LinearStep<Dim> step = newton_step(system, problem, phi);
        step.held_shift.setZero(Dim, state.positions.cols());
        BlockVector<Dim> dx = BlockVector<Dim>::Zero(Dim, phi.gradient.cols());
        if (!has_solved(system.solve(state, step, dx, report), report)) {
            return false;
        }
        if (dx.template lpNorm<Eigen::Infinity>() < kNegligible * extent) {
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
                       || (trial.energies.contact > 0
                           && next.value - phi.value <= kMostRise * (begin.value - phi.value)
                           && has_less_force(phi, next, factor));
            if (is_taken) {
                std::swap(state, trial);
                phi = std::move(next);
            }
        }
        if (state.energies.contact > 0) {
            best.see(state, phi.gradient.norm());
        }
        const bool is_cut =
            !is_taken || factor < 0.5;  // it was halved once more behind the last trial
        const bool has_stalled =
            is_cut && before - phi.value <= kKinkGain * (begin.value - phi.value);
        if ((has_stalled || best.age >= kKinkIterations) && is_at_kink()) {
            return true;
        }
        if (!is_taken) {
            report.failure = "the line search found no decrease";
            return false;
        }
    }
    if (is_at_kink()) {
        return true;
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
