#pragma once

#include "system.h"
#include "world.h"

namespace pent::simulator {

/// What the end x of a time step minimizes, held vertices being where their motion has them:
///
///     phi(x) = inertia/2 |x - target|_M^2 + scale E(x)
///            + scale rate/2 (a |x - origin|_M^2 + b |x - origin|_K^2)
///
/// E is the energy of elasticity, gravity and obstacles; a and b are those of Rayleigh damping, K the
/// tangent at the start of the step, and rate (x - origin) the velocity at its end. Backward
/// Euler, BDF2 and statics differ in the numbers alone.
template <int Dim>
struct StepProblem {
    double inertia = 1;     ///< 0 for statics.
    double scale = 0;       ///< s^2; m^0 for statics.
    double rate = 0;        ///< 1/s.
    double time = 0;        ///< At the end of the step, s.
    Positions<Dim> target;  ///< Dim x vertices: where inertia alone would carry them, m.
    Positions<Dim> origin;  ///< Dim x vertices, m.
    Positions<Dim> held;    ///< Dim x vertices: held ones at the end of the step, m.
};

/// A past state that BDF2 looks back to.
template <int Dim>
struct History {
    Positions<Dim> positions;   ///< m.
    Positions<Dim> velocities;  ///< m/s.
};

/// x_(n+1) - x_n = h v_(n+1), v_(n+1) - v_n = h a_(n+1).
template <int Dim>
[[nodiscard]] StepProblem<Dim> euler_problem(const BodyState<Dim>& now, double h);

/// 3 x_(n+1) - 4 x_n + x_(n-1) = 2 h v_(n+1), and the same for v: second order in h.
template <int Dim>
[[nodiscard]] StepProblem<Dim> bdf2_problem(const BodyState<Dim>& now,
                                            const History<Dim>& before,
                                            double h);

/// No inertia: every step ends in equilibrium with where the held vertices are.
template <int Dim>
[[nodiscard]] StepProblem<Dim> static_problem(const BodyState<Dim>& now, double h);

/// One Newton step from `now`: for Euler, Eq. 3 of [shi2025] ([baraff1998]).
///
/// @param x  Dim x vertices; set to the end of the step where it returns true.
template <int Dim>
[[nodiscard]] bool take_linear_step(System<Dim>& system,
                                    const World<Dim>& world,
                                    const StepProblem<Dim>& problem,
                                    const BodyState<Dim>& now,
                                    Positions<Dim>& x,
                                    StepReport& report);

/// Newton's method with line search. It begins with the linear step, which spreads the motion of held
/// vertices over all; if phi is larger there than with every free vertex where it was, it begins here.
///
/// Ends when the unbalanced force, the gradient of phi, is below SolverOptions::newton_tolerance
/// times that at the start, or corrections are below 1e-10 of `extent`.
///
/// @param state  Positions at the end of the step, forces and energies there.
template <int Dim>
[[nodiscard]] bool minimize(System<Dim>& system,
                            const World<Dim>& world,
                            const StepProblem<Dim>& problem,
                            const BodyState<Dim>& now,
                            double extent,
                            BodyState<Dim>& state,
                            StepReport& report);

}  // namespace pent::simulator
