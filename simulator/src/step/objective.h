#pragma once

#include <pent/simplex_mesh.h>

#include <string>
#include <vector>

namespace pent::simulator {

/// A function at one point.
template <int Dim>
struct Evaluation {
    double value = 0;
    double rounding = 0;    ///< What terms of the value that cancel may leave of it.
    bool has_kink = false;  ///< Whether the gradient is not quite the derivative of the value here.
    Positions<Dim> gradient;  ///< Dim x points; 0 where a variable is fixed.
};

/// How large a gradient is: |gradient|, and the same in other norms in which as little may be left.
using GradientNorms = std::vector<double>;

/// Where Newton's method would go.
template <int Dim>
struct NewtonDirection {
    Positions<Dim> step;         ///< Dim x points.
    std::string failure_reason;  ///< Why there is none; empty if there is.
};

/// What Newton's method minimizes: a function of the coordinates of many points.
///
/// Some of them may be prescribed: they are not to be chosen, but to be brought to their places.
template <int Dim>
class Objective {
public:
    Objective() = default;
    virtual ~Objective() = default;
    Objective(const Objective&) = delete;
    Objective& operator=(const Objective&) = delete;
    Objective(Objective&&) = delete;
    Objective& operator=(Objective&&) = delete;

    [[nodiscard]] virtual Evaluation<Dim> evaluate(const Positions<Dim>& x) = 0;

    /// In the same norms at every call.
    [[nodiscard]] virtual GradientNorms norms(const Positions<Dim>& gradient) const {
        return {gradient.norm()};
    }

    /// -(Hessian)^-1 gradient at the point last evaluated, prescribed points moving by
    /// `displacement`.
    ///
    /// @param gradient   There, as evaluate() gave it.
    /// @param tolerance  Residual of the linear solve over that at its start; 0 for the best there
    /// is.
    [[nodiscard]] virtual NewtonDirection<Dim> solve(const Positions<Dim>& gradient,
                                                     const Positions<Dim>& displacement,
                                                     double tolerance) = 0;

    /// How far prescribed points are from their places at x; 0 for all others.
    [[nodiscard]] virtual Positions<Dim> prescribed_displacement(const Positions<Dim>& x) const {
        return Positions<Dim>::Zero(Dim, x.cols());
    }

    /// The largest part of the way at which the value is finite all along, in [0, 1].
    [[nodiscard]] virtual double max_step(const Positions<Dim>& /*from*/,
                                          const Positions<Dim>& /*to*/) {
        return 1;
    }

    /// Told of every point that was accepted. Returns whether the function has changed.
    [[nodiscard]] virtual bool accept(const Positions<Dim>& /*x*/) { return false; }
};

}  // namespace pent::simulator
