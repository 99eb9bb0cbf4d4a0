#include "potential.h"

#include <algorithm>
#include <cmath>
#include <optional>
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

// Newton's method has converged as well where a correction, taken whole, was below this many times its
// tolerance of the distance of contact, and the unbalanced force is below as many times what it asks
// for: two thousandths of either, by default.
constexpr double kSettled = 20;

// Filtered Hessians are too stiff where bodies slide along each other, so that energy still falls behind
// a whole step. One at whose end the slope is above this part of that at its start goes on, to where
// the slope would vanish if it changed evenly, at most so many times as far, and so many times.
constexpr double kSteep = 0.35;
constexpr double kMostStretch = 4;
constexpr int kMostStretches = 4;
constexpr double kLeastStretch = 1.3;  // anything less is not worth an evaluation

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

// Where Newton's method would go.
template <int Dim>
struct Direction {
    BlockVector<Dim> dx;       // of the unknowns
    Positions<Dim> positions;  // of all vertices, held ones too
    double slope = 0;          // of phi, by dx
};

// Moves on from a state along a direction, as far as the energy falls.
template <int Dim>
class Mover {
public:
    Mover(System<Dim>& system, const World<Dim>& world, const StepProblem<Dim>& problem)
        : system_(system), world_(world), problem_(problem) {}

    // Returns how many times the direction was gone: `factor`, half of it and so on; more where
    // `factor` is 1 and goes on falling; nothing if the energy does not fall.
    std::optional<double> move(const Direction<Dim>& direction,
                               double factor,
                               bool is_free_to_rise,
                               BodyState<Dim>& state,
                               Potential<Dim>& phi) {
        const Positions<Dim> from = state.positions;
        for (int k = 0; k < kMostBacktracks; ++k, factor /= 2) {
            Potential<Dim> next = try_out(from, direction, factor, state);
            if (is_free_to_rise ? std::isfinite(next.value)
                                : has_improved(phi, next, factor, direction.slope)) {
                std::swap(state, trial_);
                phi = std::move(next);
                if (factor == 1 && !is_free_to_rise) {
                    factor = stretch(from, direction, state, phi);
                }
                system_.tell_move(state.positions, false);
                return factor;
            }
        }
        return std::nullopt;
    }

private:
    Potential<Dim> try_out(const Positions<Dim>& from,
                           const Direction<Dim>& direction,
                           double factor,
                           const BodyState<Dim>& state) {
        trial_.velocities = state.velocities;
        trial_.positions = from + factor * direction.positions;
        system_.evaluate(trial_);
        return potential(system_, world_, problem_, trial_);
    }

    // Goes on from a whole step while the energy falls; returns how far in all.
    double stretch(const Positions<Dim>& from,
                   const Direction<Dim>& direction,
                   BodyState<Dim>& state,
                   Potential<Dim>& phi) {
        double factor = 1;
        for (int k = 0; k < kMostStretches; ++k) {
            const double slope = phi.gradient.cwiseProduct(direction.dx).sum();
            if (!(slope < kSteep * direction.slope)) {
                break;
            }
            const double most = kMostStretch * factor;
            const double bend = (slope - direction.slope) / factor;
            const double wanted = bend > 0 ? std::min(most, -direction.slope / bend) : most;
            const double limit =
                system_.limit_step(from, from + wanted * direction.positions).fraction;
            if (limit * wanted < kLeastStretch * factor) {
                break;
            }
            Potential<Dim> next = try_out(from, direction, limit * wanted, state);
            if (!(next.value < phi.value)) {
                break;
            }
            std::swap(state, trial_);
            phi = std::move(next);
            factor = limit * wanted;
        }
        return factor;
    }

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
        Direction<Dim> direction{BlockVector<Dim>::Zero(Dim, phi.gradient.cols()), shift, 0};
        if (!has_solved(system.solve(state, step, direction.dx, report), report)) {
            return false;
        }
        const double correction = direction.dx.template lpNorm<Eigen::Infinity>();
        if (!is_carried && correction < invisible) {
            return true;
        }
        add_to_free(world, 1, direction.dx, direction.positions);
        direction.slope = phi.gradient.cwiseProduct(direction.dx).sum();
        limit = system.limit_step(state.positions, state.positions + direction.positions);
        const double gap = smallest_gap(state);
        const std::optional<double> factor =
            mover.move(direction, limit.fraction, is_carried, state, phi);
        if (!factor) {
            report.failure = "the line search found no decrease";
            return false;
        }
        if (!is_carried && *factor >= 1 && *factor * correction < kSettled * invisible
            && phi.gradient.norm() <= kSettled * tolerance * start) {
            report.unbalanced = std::max(report.unbalanced, phi.gradient.norm() / start);
            return true;
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
