// How a Stepper takes one step, or throws the attempt away: Stepper::advance() and what it is made
// of.

#include "step/newton.h"
#include "step/stepper.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <sstream>
#include <utility>

namespace pent::simulator {

namespace {

// Newton steps are negligible below this part of the scene's extent, which counts as at most so
// many times that of the smallest body: that has to be resolved where others are far larger, or far
// away. Below the rounding of coordinates, this part of the largest, they are negligible, too.
constexpr double kNegligible = 1e-10;
constexpr double kMaxOfSmallest = 1e3;
constexpr double kRoundingOfPlaces = 1e-13;

// With a barrier, Newton's method has also converged after a full step below this many times its
// least one, where the residual is below as many times the tolerance: both are two thousandths, of
// the activation distance and of the residual at the start, by default.
constexpr double kSettled = 20;

// A step in which something moves by so many extents of the scene has diverged; farther out
// crossings would drown in rounding.
constexpr double kMaxExtents = 1e3;

// With a barrier, Newton's method recovers from one Newton step as long as that, which a state far
// from rest may lead to: collision detection cuts it short. From so many in a row it does not, and
// each costs a search among all that lies on so long a way.
constexpr int kMaxAstray = 3;

// Dirichlet vertices have arrived when they are this part of the scene's extent from their place.
constexpr double kArrived = 1e-14;

constexpr int kMaxIterations = 50;
constexpr int kMaxBoundedIterations = 150;

// Iterations of a damped step: twice as many bring back no more bodies, and cost more in all.
constexpr int kDampedIterations = 4;

// The places of held vertices at a time.
template <int Dim>
PrescribedPlaces<Dim> prescribed_places(const HeldVertices<Dim>& held,
                                        double time,
                                        Positions<Dim> positions) {
    held.place(time, positions, nullptr);
    PrescribedPlaces<Dim> prescribed;
    for (std::uint32_t vertex = 0; vertex < positions.cols(); ++vertex) {
        if (held.is_held(vertex)) {
            prescribed.vertices.push_back(vertex);
        }
    }
    prescribed.places = positions(Eigen::all, prescribed.vertices);
    return prescribed;
}

}  // namespace

template <int Dim>
StepProblem<Dim> Simulation<Dim>::Stepper::make_problem(double time, double h) const {
    const bool has_even_past = history_.positions.cols() > 0 && h == scene_.dt();
    StepProblem<Dim> problem =
        step_problem(scene_.solver.integrator, current_, has_even_past ? &history_ : nullptr, h);
    problem.time = time + h;
    problem.prescribed = prescribed_places<Dim>(held_, time + h, current_.positions);
    return problem;
}

template <int Dim>
void Simulation<Dim>::Stepper::set_velocities(const StepProblem<Dim>& problem, double time) {
    next_.velocities = problem.rate * (next_.positions - problem.origin);
    held_.place(time, next_.positions, &next_.velocities);
    still(next_.velocities);
}

// Why the new state can only be that of a failed step; empty if it need not be. With Newton's
// method the kinetic energy at the end is in the budget, since it may become elastic; a linear step
// that diverges makes both from nothing. A damped step gains no energy but what held vertices that
// move put into it.
template <int Dim>
std::string Simulation<Dim>::Stepper::excess(const Energies& before, Method method) const {
    constexpr double kMaxGrowth = 1e2;
    if (!next_.positions.allFinite() || !next_.velocities.allFinite()
        || !energy_.sum.gradient().allFinite()
        || (next_.positions - current_.positions).cwiseAbs().maxCoeff() >= kMaxExtents * extent_) {
        return "the motion grew beyond all bounds";
    }
    const double budget = bodies_.large_energy + before.of("elastic") + before.kinetic
                          + (method == Method::Newton ? kinetic_energy(next_.velocities) : 0);
    const bool has_grown = !(energy_.elasticity->energy() < kMaxGrowth * budget);
    return has_grown && method != Method::Damped
               ? "the elastic energy grew a hundred times; take smaller steps, or newton_euler,"
                 " which comes back from far"
               : "";
}

// Why something may have passed through something else in one step (tunneling); empty if nothing
// has moved so far. Penalties see only what is near or inside at the end of a step. With a barrier
// no iterate of Newton's method crosses anything, but all of them together may lead around what is
// in the way.
template <int Dim>
std::string Simulation<Dim>::Stepper::tunneling() const {
    if (energy_.contact->is_empty()) {
        return "";
    }
    constexpr const char* kAdvice = "; take smaller steps";
    const Positions<Dim> moves = next_.positions - current_.positions;
    const Eigen::Matrix<double, Dim, 1> mean = moves.rowwise().mean();
    const double largest = moves.colwise().norm().maxCoeff();
    const double largest_apart = (moves.colwise() - mean).colwise().norm().maxCoeff();
    if (energy_.contact->is_bounded()) {
        // Against obstacles what all do together counts.
        const double most = scene_.obstacles.empty() ? largest_apart : largest;
        return most > thinnest_
                       && energy_.contact->max_step(current_.positions, next_.positions) < 1
                   ? "something got around what is in its way in one step, by more than the extent"
                     " of the thinnest body: "
                         + energy_.contact->describe(energy_.contact->limit().limiting) + kAdvice
                   : "";
    }
    if (energy_.contact->do_bodies_meet() && largest_apart > thinnest_) {
        return std::string(
                   "in contact something moved by more than the extent of the thinnest"
                   " body: bodies could pass through each other unseen")
               + kAdvice;
    }
    const std::string passed =
        energy_.contact->obstacle_passed(current_.positions, next_.positions);
    return passed.empty() ? "" : passed + " in one step, unseen by penalties" + kAdvice;
}

// The length below which a Newton step is negligible, m.
template <int Dim>
double Simulation<Dim>::Stepper::negligible_correction() const {
    const double rounding = kRoundingOfPlaces * current_.positions.cwiseAbs().maxCoeff();
    return std::max(kNegligible * std::min(extent_, kMaxOfSmallest * smallest_),
                    std::min(kNegligible * extent_, rounding));
}

// Newton's method without a barrier. Dirichlet vertices are at their places from the beginning, and
// a first, linear iteration spreads their motion over all others. If the value is larger after it
// than with every free vertex where it was, the method begins at the latter. A damped step is a few
// iterations of the same: its energy is bounded, as they only ever lower what is minimized.
template <int Dim>
NewtonReport Simulation<Dim>::Stepper::minimize(Method method) {
    const auto displaced = [&](const Positions<Dim>& x) -> Positions<Dim> {
        return x + potential_.prescribed_displacement(x);
    };
    NewtonStart at_start;
    {  // a scope, so that the memory of the gradient is free for what follows
        const Evaluation<Dim> start = potential_.evaluate(displaced(current_.positions));
        at_start = {start.value, potential_.norms(start.gradient)};
    }
    const bool is_damped = method == Method::Damped;
    if (is_damped) {  // the linear step was taken, and thrown away
        next_.positions = displaced(next_.positions);
    } else {
        next_.positions = current_.positions;
        NewtonReport first = newton_step(potential_, next_.positions);
        if (!first.has_converged) {
            return first;
        }
    }
    if (!(potential_.evaluate(next_.positions).value <= at_start.value)) {
        next_.positions = displaced(current_.positions);
    }
    return newton(potential_,
                  {.tolerance = scene_.solver.newton_tolerance,
                   .min_correction = negligible_correction(),
                   .bound = kMaxExtents * extent_,
                   .max_iterations = is_damped ? kDampedIterations : kMaxIterations,
                   .may_stop_short = is_damped,
                   .start = at_start},
                  next_.positions);
}

// Newton's method with a barrier: every iterate, and the straight way from one to the next, is free
// of crossings. Begins where everything is; Dirichlet vertices go on as far as each iteration lets
// them.
template <int Dim>
NewtonReport Simulation<Dim>::Stepper::minimize_bounded(const StepProblem<Dim>& problem) {
    const double tolerance = scene_.solver.newton_tolerance;
    next_.positions = current_.positions;
    potential_.tell_start(next_.positions);
    potential_.balance(next_.positions);
    NewtonReport report =
        newton(potential_,
               {.tolerance = tolerance,
                // Steps that are invisible beside the activation distance.
                .min_correction = std::max(negligible_correction(),
                                           tolerance * std::min(scene_.contact->distance, extent_)),
                .settled = kSettled,
                .bound = kMaxExtents * extent_,
                .max_astray = kMaxAstray,
                .arrival = kArrived * extent_,
                .max_iterations = kMaxBoundedIterations,
                .extends_steps = true},
               next_.positions);
    if (report.has_blocked_points) {
        std::ostringstream message;
        message << "held vertices cannot go on without a crossing at t = " << problem.time
                << " s: " << energy_.contact->describe(energy_.contact->limit().limiting);
        report.failure_reason = message.str();
    }
    report.iterations = std::max(0, report.iterations - 1);  // the first is that of a linear step
    return report;
}

template <int Dim>
NewtonReport Simulation<Dim>::Stepper::solve(const StepProblem<Dim>& problem, Method method) {
    if (method == Method::Linear) {
        next_.positions = current_.positions;
        NewtonReport report = newton_step(potential_, next_.positions);
        report.iterations = 0;
        return report;
    }
    return energy_.sum.is_bounded() ? minimize_bounded(problem) : minimize(method);
}

template <int Dim>
typename Simulation<Dim>::Stepper::Method Simulation<Dim>::Stepper::choose_method() const {
    const bool is_linear = scene_.solver.integrator == Integrator::LinearEuler
                           || (potential_.dofs().count() == 0 && islands_.asleep_count() == 0
                               && !energy_.contact->is_bounded());
    return is_linear ? Method::Linear : Method::Newton;
}

// Tells the terms of the step that begins.
template <int Dim>
void Simulation<Dim>::Stepper::begin(const std::shared_ptr<const StepProblem<Dim>>& problem,
                                     double h,
                                     Method method) {
    Positions<Dim> displacement = Positions<Dim>::Zero(Dim, current_.positions.cols());
    problem->prescribed.put_into(displacement);
    for (const std::uint32_t vertex : problem->prescribed.vertices) {
        displacement.col(vertex) -= problem->origin.col(vertex);
    }
    potential_.begin_step(problem, {current_.positions, current_.velocities, problem->origin,
                                    displacement, h, problem->rate, method == Method::Linear});
    potential_.accept_rough_directions(method == Method::Damped);
}

template <int Dim>
void Simulation<Dim>::Stepper::Attempts::add(const Attempts& later) {
    outcome = later.outcome;
    failure = later.failure.empty() ? failure : later.failure;
    taken += later.taken;
    refused += later.refused;
    damped += later.damped;
    newton_iterations += later.newton_iterations;
    unbalanced = std::max(unbalanced, later.unbalanced);
}

template <int Dim>
typename Simulation<Dim>::Stepper::Attempts Simulation<Dim>::Stepper::Attempts::refuse(
    std::string reason, Outcome how) const {
    Attempts all = *this;
    all.add({.outcome = how, .failure = std::move(reason), .refused = 1});
    return all;
}

template <int Dim>
typename Simulation<Dim>::Stepper::Attempts Simulation<Dim>::Stepper::attempt(double time,
                                                                              double h,
                                                                              bool is_damped) {
    Attempts now;
    const auto problem = std::make_shared<const StepProblem<Dim>>(make_problem(time, h));
    next_.velocities.resize(Dim, 0);  // frees memory: the solve needs most, and not these
    energy_.sum.set_time({time, time + h});
    if (std::string reason = energy_.contact->obstacle_in_the_way(current_.positions);
        !reason.empty()) {
        return now.refuse(std::move(reason), Outcome::Refused);
    }
    energy_.sum.update(current_.positions);
    static_cast<void>(wake_for(problem->prescribed));
    energy_.sum.update(current_.positions);
    const Energies before{kinetic_energy(current_.velocities), energy_.sum.energies()};
    const Method method = is_damped ? Method::Damped : choose_method();
    begin(problem, h, method);
    const NewtonReport solved = solve(*problem, method);
    now.newton_iterations = solved.iterations;
    now.unbalanced = std::max(now.unbalanced, solved.residual);
    if (!solved.has_converged) {
        // Where strains are above one the matrix of a linear step may have no solution.
        const bool is_astray =
            method == Method::Linear && before.of("elastic") > bodies_.large_energy;
        return now.refuse(solved.failure_reason, is_astray ? Outcome::Astray : Outcome::Refused);
    }
    set_velocities(*problem, time + h);
    if (method == Method::Linear) {
        energy_.sum.set_time({time, time + h});  // the solve saw obstacles at the start
    }
    energy_.sum.update(next_.positions);
    if (std::string reason = excess(before, method); !reason.empty()) {
        return now.refuse(std::move(reason),
                          method == Method::Linear ? Outcome::Astray : Outcome::Refused);
    }
    if (std::string reason = tunneling(); !reason.empty()) {
        return now.refuse(std::move(reason), Outcome::Refused);
    }
    if (const std::string pair = energy_.contact->touching(current_.positions, next_.positions);
        !pair.empty()) {
        return now.refuse("the step would end where " + pair, Outcome::Refused);
    }
    // Newton's method has contacts at the end of the step: a sleeping body that was run into there
    // wakes, and gives way in another attempt.
    if (method != Method::Linear && wake_for(problem->prescribed)) {
        now.add(attempt(time, h, is_damped));
        return now;
    }
    if (scene_.solver.integrator == Integrator::Bdf2) {
        history_ = h == scene_.dt() ? current_ : State<Dim>();
    }
    current_ = next_;  // copied: hosts see the arrays where they lie
    now.taken = 1;
    now.damped = is_damped ? 1 : 0;
    return now;
}

template <int Dim>
typename Simulation<Dim>::Stepper::Attempts Simulation<Dim>::Stepper::advance(double time,
                                                                              double h,
                                                                              int depth) {
    Attempts all = attempt(time, h, false);
    if (all.outcome == Outcome::Astray) {
        Attempts damped = attempt(time, h, true);
        damped.failure = all.failure;  // tells what to change, even if the damped step succeeds
        all.add(damped);
    }
    if (all.outcome == Outcome::Taken || depth >= scene_.solver.max_halvings) {
        return all;
    }
    // The first part may be taken and the second not: then the step gives all of it back.
    const bool is_whole = depth == 0;
    const State<Dim> start = is_whole ? current_ : State<Dim>();
    const State<Dim> history = is_whole ? history_ : State<Dim>();
    all.add(advance(time, h / 2, depth + 1));
    if (all.outcome == Outcome::Taken) {
        all.add(advance(time + h / 2, h / 2, depth + 1));
    }
    if (is_whole && all.outcome != Outcome::Taken) {
        current_ = start;  // copied: hosts see the arrays where they lie
        history_ = history;
    }
    return all;
}

#define PENT_INSTANTIATE(Dim)                                                               \
    template typename Simulation<Dim>::Stepper::Attempts Simulation<Dim>::Stepper::advance( \
        double, double, int);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
