#pragma once

#include <pent/simplex_mesh.h>

#include <string>
#include <vector>

namespace pent::simulator {

/// A function at one point.
template <int Dim>
struct Evaluation {
    double value = 0;
    double rounding = 0;    ///< Error of the value where large terms of it cancel.
    bool has_kink = false;  ///< Whether the gradient is not quite the derivative of the value here.
    Positions<Dim> gradient;  ///< Dim x points; 0 where a variable is fixed.
};

/// Sizes of a gradient: |gradient|, and those in other norms. All of them have to become small.
using GradientNorms = std::vector<double>;

/// The Newton step from a point.
template <int Dim>
struct NewtonDirection {
    Positions<Dim> step;         ///< Dim x points.
    std::string failure_reason;  ///< Why there is none; empty if there is.
};

/// What Newton's method minimizes: a function of the coordinates of many points.
///
/// Some of the points may be prescribed: they are no variables, but have to be brought to given
/// places.
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

    /// Sizes of a gradient, in the same norms at every call.
    [[nodiscard]] virtual GradientNorms norms(const Positions<Dim>& gradient) const {
        return {gradient.norm()};
    }

    /// The Newton step -(Hessian)^-1 gradient at the point last evaluated, prescribed points moving
    /// by `displacement`.
    ///
    /// @param gradient   There, as evaluate() gave it.
    /// @param tolerance  Of the linear solve: its residual over that at its start; 0 for the best
    ///                   there is.
    [[nodiscard]] virtual NewtonDirection<Dim> solve(const Positions<Dim>& gradient,
                                                     const Positions<Dim>& displacement,
                                                     double tolerance) = 0;

    /// How far prescribed points are from their places at x; 0 for all others.
    [[nodiscard]] virtual Positions<Dim> prescribed_displacement(const Positions<Dim>& x) const {
        return Positions<Dim>::Zero(Dim, x.cols());
    }

    /// The largest fraction of the way, in [0, 1], along which the value is finite.
    [[nodiscard]] virtual double max_step(const Positions<Dim>& /*from*/,
                                          const Positions<Dim>& /*to*/) {
        return 1;
    }

    /// Called at every point that is accepted, which is then the point last evaluated. Returns
    /// whether the function has changed, as where a stiffness adapts.
    [[nodiscard]] virtual bool accept(const Positions<Dim>& /*x*/) { return false; }
};

}  // namespace pent::simulator
