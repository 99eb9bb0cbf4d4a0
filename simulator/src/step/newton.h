#pragma once

#include "step/objective.h"

#include <limits>
#include <optional>
#include <string>

namespace pent::simulator {

/// Where progress is measured from: convergence is relative to the gradient here.
struct NewtonStart {
    double value = 0;
    GradientNorms norms;
};

struct NewtonOptions {
    double tolerance = 1e-4;    ///< Converged where no norm of the gradient is above this part of
                                ///< what it was at the start; in (0, 1).
    double min_correction = 0;  ///< Converged, too, where no coordinate of a Newton step is larger.
    double settled = 0;  ///< Converged, too, after a full step below `settled` times min_correction
                         ///< with a gradient below `settled` tolerances; 0 for no such rule.
    double bound =
        std::numeric_limits<double>::infinity();  ///< Diverged where a coordinate is farther
                                                  ///< than this from its start.
    int max_astray = 0;  ///< Diverged, too, after so many Newton steps in a row that would go
                         ///< beyond the bound, however short they were cut; 0 for no such rule.
    double arrival = 0;  ///< A prescribed point this near to its place has arrived.
    int max_iterations = 150;
    bool may_stop_short = false;  ///< Whether max_iterations, or a line search without decrease
                                  ///< behind the first iteration, count as success.
    bool extends_steps = false;   ///< Whether the line search may go beyond a full step.
    std::optional<NewtonStart> start = {};  ///< Absent: the point where the iteration begins.
};

struct NewtonReport {
    bool has_converged = false;
    std::string failure_reason;       ///< Empty if it has.
    bool has_blocked_points = false;  ///< Prescribed points could not get to their places.
    int iterations = 0;               ///< Linear solves.
    double residual = 0;  ///< Gradient at the end over that at the start, in the norm in which most
                          ///< is left; 0 if it ended by a negligible step.
};

/// Minimizes a function by Newton's method with a backtracking line search, beginning at x, where
/// the result is left.
///
/// Steps stay where the function is finite. They are halved until the value decreases sufficiently
/// (Armijo's rule) or, where the decrease drowns in rounding, until the gradient does [nocedal2006,
/// 3.1]. While prescribed points are on their way to their places the value may rise.
///
/// A minimum at a kink has no vanishing gradient. There the method ends with success once the
/// gradient is below a tenth of that at the start, and either a step that had to be cut gains
/// almost nothing or the gradient has not decreased for several iterations.
template <int Dim>
[[nodiscard]] NewtonReport newton(Objective<Dim>& function,
                                  const NewtonOptions& options,
                                  Positions<Dim>& x);

/// The first iteration alone, taken whole: x + step.
template <int Dim>
[[nodiscard]] NewtonReport newton_step(Objective<Dim>& function, Positions<Dim>& x);

}  // namespace pent::simulator
