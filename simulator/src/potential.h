#pragma once

#include "step_problem.h"

#include <cmath>

// What the two forms of Newton's method have in common.

namespace pent::simulator {

/// Least part of the decrease that the slope promises for a step to be taken [nocedal2006, 3.1].
inline constexpr double kArmijo = 1e-4;

/// Corrections below this part of the scene's extent are none.
inline constexpr double kNegligible = 1e-10;

template <int Dim>
struct Potential {
    double value = 0;
    double rounding = 0;        ///< What terms of the elastic energy that cancel may leave of it.
    BlockVector<Dim> gradient;  ///< Dim x unknowns.
};

/// phi of StepProblem at a state whose forces and energies are up to date.
template <int Dim>
[[nodiscard]] Potential<Dim> potential(const System<Dim>& system,
                                       const World<Dim>& world,
                                       const StepProblem<Dim>& problem,
                                       const BodyState<Dim>& state);

/// Sufficient decrease of the unbalanced force.
template <int Dim>
[[nodiscard]] bool has_less_force(const Potential<Dim>& phi,
                                  const Potential<Dim>& next,
                                  double factor) {
    return next.gradient.norm() <= (1 - kArmijo * factor) * phi.gradient.norm();
}

/// Sufficient decrease of phi along a direction of this slope; where that drowns in rounding, of the
/// unbalanced force.
template <int Dim>
[[nodiscard]] bool has_improved(const Potential<Dim>& phi,
                                const Potential<Dim>& next,
                                double factor,
                                double slope) {
    constexpr double kRounding = 1e-13;  // of phi
    const double change = next.value - phi.value;
    return change <= kArmijo * factor * slope + kRounding * std::abs(phi.value)
           || (change <= phi.rounding && has_less_force(phi, next, factor));
}

/// Held vertices at the end of the step minus where they are in x; zero for free ones.
template <int Dim>
[[nodiscard]] Positions<Dim> held_shift(const World<Dim>& world,
                                        const StepProblem<Dim>& problem,
                                        const Positions<Dim>& x);

/// The equation of a Newton iteration, without a shift of held vertices.
template <int Dim>
[[nodiscard]] LinearStep<Dim> newton_step(const System<Dim>& system,
                                          const StepProblem<Dim>& problem,
                                          const Potential<Dim>& phi);

template <int Dim>
void add_to_free(const World<Dim>& world,
                 double factor,
                 const BlockVector<Dim>& dx,
                 Positions<Dim>& x);

/// Whether a linear solve came to its end; if not, the report says why.
[[nodiscard]] bool has_solved(const LinearSolveReport& solved, StepReport& report);

/// minimize() with a barrier: every iterate, and the straight way from one to the next, is free of
/// crossings. Starts where everything is; held vertices go on as far as each iteration lets them.
template <int Dim>
[[nodiscard]] bool minimize_without_crossing(System<Dim>& system,
                                             const World<Dim>& world,
                                             const StepProblem<Dim>& problem,
                                             const BodyState<Dim>& now,
                                             double extent,
                                             BodyState<Dim>& state,
                                             StepReport& report);

}  // namespace pent::simulator
