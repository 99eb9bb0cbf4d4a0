#include "potential.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace pent::simulator {

namespace {

constexpr int kMostIterations = 150;
constexpr int kMostBacktracks = 40;

// Gaps below these parts of the distance of contact: a step starts with the stiffness that would
// balance its forces there, and an iteration that comes nearer still doubles it.
constexpr double kDeep = 0.1;
constexpr double kTight = 0.01;

// Held vertices that get no further than this part of their way, so many times in a row, are stuck.
constexpr double kStuck = 1e-3;
constexpr int kMostStuck = 10;

// Held vertices have arrived when they are this part of the scene's extent from their place.
constexpr double kArrived = 1e-14;

// The stiffness never is more than this times that of the scene.
constexpr double kMostStiffness = 1e8;

template <int Dim>
double smallest_gap(const BodyState<Dim>& state) {
    return state.contacts->barrier.report.smallest_gap;
}

// The stiffness with which the barrier would balance, in the sense of least squares, all other forces
// where bodies are now; that of the scene unless they are close [li2020, supplement].
template <int Dim>
double balancing_stiffness(const System<Dim>& system,
                           const World<Dim>& world,
                           const StepProblem<Dim>& problem,
                           const BodyState<Dim>& state) {
    const Contact& options = system.contacts().options();
    if (!(smallest_gap(state) < kDeep * options.distance)) {
        return options.stiffness;
    }
    const BlockVector<Dim> gradient = potential(system, world, problem, state).gradient;
    double along = 0;
    double squared = 0;
    for (std::uint32_t unknown = 0; unknown < world.numbering.free_count(); ++unknown) {
        const Vector<Dim> push =
            problem.scale
            * state.contacts->barrier_forces.col(world.numbering.vertex_of_unknown[unknown]);
        along += (gradient.col(unknown) + push).dot(push);
        squared += push.squaredNorm();
    }
    const double balancing = squared > 0 ? system.contacts().stiffness() * along / squared : 0;
    return std::clamp(balancing, options.stiffness, kMostStiffness * options.stiffness);
}

template <int Dim>
std::string stuck_message(const System<Dim>& system, const contact::StepLimit& limit, double time) {
    std::ostringstream message;
    message << "held vertices cannot go on without a crossing at t = " << time
            << " s: " << system.contacts().describe(limit.limiting);
    return message.str();
}

// Moves on from a state along a direction, as far as the energy falls; false if it does not.
template <int Dim>
class Mover {
public:
    Mover(System<Dim>& system, const World<Dim>& world, const StepProblem<Dim>& problem)
        : system_(system), world_(world), problem_(problem) {}

    bool move(const Positions<Dim>& direction,
              double slope,
              double factor,
              bool is_free_to_rise,
              BodyState<Dim>& state,
              Potential<Dim>& phi) {
        trial_.velocities = state.velocities;
        for (int k = 0; k < kMostBacktracks; ++k, factor /= 2) {
            trial_.positions = state.positions + factor * direction;
            system_.evaluate(trial_);
            Potential<Dim> next = potential(system_, world_, problem_, trial_);
            if (is_free_to_rise ? std::isfinite(next.value)
                                : has_improved(phi, next, factor, slope)) {
                std::swap(state, trial_);
                phi = std::move(next);
                system_.tell_move(state.positions, false);
                return true;
            }
        }
        return false;
    }

private:
    System<Dim>& system_;
    const World<Dim>& world_;
    const StepProblem<Dim>& problem_;
    BodyState<Dim> trial_;
};

}  // namespace

template <int Dim>
bool minimize_without_crossing(System<Dim>& system,
                               const World<Dim>& world,
                               const StepProblem<Dim>& problem,
                               const BodyState<Dim>& now,
                               double extent,
                               BodyState<Dim>& state,
                               StepReport& report) {
    const Contact& contact = system.contacts().options();
    const double tolerance = system.options().newton_tolerance;
    // Corrections that nobody can see, next to the distance of contact.
    const double invisible =
        std::max(kNegligible * extent, tolerance * std::min(contact.distance, extent));
    state = now;
    system.tell_move(state.positions, true);
    system.set_barrier_stiffness(balancing_stiffness(system, world, problem, state), state);
    Potential<Dim> phi = potential(system, world, problem, state);
    double start = phi.gradient.norm();
    Positions<Dim> shift = held_shift(world, problem, state.positions);
    bool is_carried = !shift.isZero(0);  // held vertices are still on their way
    int stuck = 0;
    contact::StepLimit limit;
    Mover<Dim> mover(system, world, problem);
    for (int iteration = 0; iteration < kMostIterations; ++iteration) {
        if (!std::isfinite(phi.value)) {
            report.failure = "the energy grew beyond all bounds";
            return false;
        }
        if (!is_carried && phi.gradient.norm() <= tolerance * start) {
            return true;
        }
        report.newton_iterations += iteration > 0 ? 1 : 0;
        LinearStep<Dim> step = newton_step(system, problem, phi);
        step.held_shift = shift;
        BlockVector<Dim> dx = BlockVector<Dim>::Zero(Dim, phi.gradient.cols());
        if (!has_solved(system.solve(state, step, dx, report), report)) {
            return false;
        }
        if (!is_carried && dx.cwiseAbs().maxCoeff() < invisible) {
            return true;
        }
        Positions<Dim> direction = shift;
        add_to_free(world, 1, dx, direction);
        limit = system.limit_step(state.positions, state.positions + direction);
        const double gap = smallest_gap(state);
        const double slope = phi.gradient.cwiseProduct(dx).sum();
        if (!mover.move(direction, slope, limit.fraction, is_carried, state, phi)) {
            report.failure = "the line search found no decrease";
            return false;
        }
        if (is_carried) {
            shift = held_shift(world, problem, state.positions);
            is_carried = shift.cwiseAbs().maxCoeff() > kArrived * extent;
            if (!is_carried) {
                shift.setZero();
            }
            start = std::max(start, phi.gradient.norm());
            stuck = limit.fraction < kStuck ? stuck + 1 : 0;
            if (is_carried && stuck == kMostStuck) {
                break;
            }
        }
        if (smallest_gap(state) < std::min(gap, kTight * contact.distance)
            && system.contacts().stiffness() < kMostStiffness * contact.stiffness) {
            system.set_barrier_stiffness(2 * system.contacts().stiffness(), state);
            phi = potential(system, world, problem, state);
        }
    }
    report.failure = is_carried ? stuck_message(system, limit, problem.time)
                                : "Newton's method did not reach its tolerance";
    return false;
}

#define PENT_INSTANTIATE(Dim)                                                               \
    template bool minimize_without_crossing(System<Dim>&, const World<Dim>&,                \
                                            const StepProblem<Dim>&, const BodyState<Dim>&, \
                                            double, BodyState<Dim>&, StepReport&);
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
