#pragma once

#include <pent/simplex_mesh.h>
#include <pent/simulator/simulation.h>
#include <pent/simulator/solver_options.h>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// Positions and velocities of all vertices, Dim x vertices.
template <int Dim>
struct State {
    Positions<Dim> positions;   ///< m.
    Positions<Dim> velocities;  ///< m/s.
};

/// Where Dirichlet vertices are to be at the end of a step, whatever acts on them.
template <int Dim>
struct PrescribedPlaces {
    std::vector<std::uint32_t> vertices;             ///< Each once.
    Positions<Dim> places = Positions<Dim>(Dim, 0);  ///< A column for each, m.

    /// Puts them there.
    ///
    /// @param positions  Dim x vertices, m.
    void put_into(Positions<Dim>& positions) const {
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            positions.col(vertices[i]) = places.col(static_cast<Eigen::Index>(i));
        }
    }
};

/// The incremental potential of a time step, which the end x of the step minimizes, Dirichlet
/// vertices being where their motion has them:
///
///     phi(x) = inertia/2 |x - target|_M^2 + scale E(x)
///            + scale rate/2 (a |x - origin|_M^2 + b |x - origin|_K^2)
///
/// E is the potential energy; a and b are those of Rayleigh damping, K the tangent at the start of
/// the step, and rate (x - origin) the velocity at its end. Backward Euler, BDF2 and statics differ
/// in the numbers alone.
template <int Dim>
struct StepProblem {
    double inertia = 1;                ///< 0 for statics.
    double scale = 0;                  ///< s^2; 1, without unit, for statics.
    double rate = 0;                   ///< 1/s.
    double time = 0;                   ///< At the end of the step, s.
    Positions<Dim> target;             ///< Dim x vertices: where inertia alone would carry them, m.
    Positions<Dim> origin;             ///< Dim x vertices: see the velocity above, m.
    PrescribedPlaces<Dim> prescribed;  ///< Dirichlet vertices.
};

/// x_(n+1) - x_n = h v_(n+1), v_(n+1) - v_n = h a_(n+1).
template <int Dim>
[[nodiscard]] StepProblem<Dim> euler_problem(const State<Dim>& now, double h);

/// 3 x_(n+1) - 4 x_n + x_(n-1) = 2 h v_(n+1), and the same for v: second order in h.
template <int Dim>
[[nodiscard]] StepProblem<Dim> bdf2_problem(const State<Dim>& now,
                                            const State<Dim>& before,
                                            double h);

/// No inertia: every step ends in equilibrium with where the Dirichlet vertices are.
template <int Dim>
[[nodiscard]] StepProblem<Dim> static_problem(const State<Dim>& now, double h);

/// The problem of a step of h seconds from now, by an integrator. `before` is the state a step of h
/// earlier, null where there is none: at first, and around steps cut in two.
template <int Dim>
[[nodiscard]] StepProblem<Dim> step_problem(Integrator integrator,
                                            const State<Dim>& now,
                                            const State<Dim>* before,
                                            double h);

}  // namespace pent::simulator
