#pragma once

#include "linear/dof_map.h"
#include "linear/newton_system.h"

#include <pent/simplex_mesh.h>
#include <pent/simulator/energies.h>
#include <pent/simulator/solver_options.h>

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace pent::simulator {

/// What a step starts from. The velocity at its end x is rate (x - origin).
template <int Dim>
struct StepStart {
    const Positions<Dim>& positions;   ///< Dim x vertices, m; where the energy was last evaluated.
    const Positions<Dim>& velocities;  ///< Dim x vertices, m/s.
    const Positions<Dim>& origin;      ///< Dim x vertices, m.
    /// Dim x vertices: from the origin to where Dirichlet vertices will be, m; 0 for all others.
    const Positions<Dim>& prescribed_displacement;
    double h = 0;            ///< s; 0 where forces are asked for, and no step begins.
    double rate = 0;         ///< 1/s.
    bool is_linear = false;  ///< A single linear solve, no Newton's method behind it.
};

/// A step in time.
struct TimeSpan {
    double begin = 0;  ///< s, >= 0.
    double end = 0;    ///< s; the same as `begin` before the first step.

    bool operator==(const TimeSpan&) const = default;
};

/// Which bodies a term makes sleep and wake together, by their places in the scene.
struct Couplings {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;  ///< In any order.
    std::vector<std::size_t> driven;  ///< Those that something outside moves in this step.
};

/// One term of what a step minimizes: a function of the positions of all vertices.
///
/// Terms know nothing of how a step is solved, and nothing of one another, but for friction, which
/// knows contact. Arrays are Dim x vertices; what a term says of vertices without a dof is left out
/// by those who sum up. Derivatives are tested against differences, each in a test of its own.
template <int Dim>
class Potential {
public:
    Potential() = default;
    virtual ~Potential() = default;
    Potential(const Potential&) = delete;
    Potential& operator=(const Potential&) = delete;
    Potential(Potential&&) = delete;
    Potential& operator=(Potential&&) = delete;

    /// Value at positions x, m; adds the gradient to `gradient`. The methods below refer to the
    /// positions last evaluated; no term keeps a reference to these.
    [[nodiscard]] virtual double evaluate(const Positions<Dim>& x, Positions<Dim>& gradient) = 0;

    /// Adds weight times the Hessian, its negative eigenvalues as `filter` says.
    ///
    /// @param x  Those last evaluated, once more.
    virtual void add_hessian(const Positions<Dim>& x,
                             double weight,
                             Filter filter,
                             NewtonSystem<Dim>& system) = 0;

    /// The parts of the value by name, for reports.
    [[nodiscard]] virtual std::vector<TermEnergy> energies() const { return {}; }

    /// Sets what depends on time as it is at the end of this step; bodies are driven that are moved
    /// in it. Returns whether the value has changed.
    [[nodiscard]] virtual bool set_time(const TimeSpan& /*step*/) { return false; }

    /// Adds what it couples at the positions last evaluated.
    virtual void add_couplings(Couplings& /*couplings*/) const {}

    /// Takes from the start of a step what is held during it, or lagged (normal forces, tangents).
    /// Returns whether the value has changed.
    [[nodiscard]] virtual bool begin_step(const StepStart<Dim>& /*start*/) { return false; }

    /// The largest fraction of the way from one place to another, in [0, 1], along which the value
    /// is finite.
    [[nodiscard]] virtual double max_step(const Positions<Dim>& /*from*/,
                                          const Positions<Dim>& /*to*/) {
        return 1;
    }

    /// Whether it is infinite somewhere, so that max_step() may be less than 1.
    [[nodiscard]] virtual bool is_bounded() const { return false; }

    /// Chooses its stiffness at the start of a step, so that its own gradient balances that of all
    /// others, Dim x dofs. Returns whether the value has changed.
    [[nodiscard]] virtual bool balance(const BlockVector<Dim>& /*own*/,
                                       const BlockVector<Dim>& /*others*/) {
        return false;
    }
    [[nodiscard]] virtual bool wants_balance() const { return false; }

    /// Adapts itself after an iteration of Newton's method that was accepted. Returns whether the
    /// value has changed.
    [[nodiscard]] virtual bool adapt() { return false; }

    /// Error of the value, by rounding, where large terms of it cancel.
    [[nodiscard]] virtual double rounding() const { return 0; }

    /// Whether the gradient is not quite the derivative of the value here, as at kinks of contact.
    [[nodiscard]] virtual bool has_kink() const { return false; }
};

}  // namespace pent::simulator
