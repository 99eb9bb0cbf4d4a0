#pragma once

#include "step/objective.h"

#include <limits>
#include <optional>
#include <string>

namespace pent::simulator {

/// What counts as the start.
struct NewtonStart {
    double value = 0;
    GradientNorms norms;
};

struct NewtonOptions {
    double tolerance = 1e-4;  ///< Of all norms of the gradient over those at the start, in (0, 1).
    double min_correction = 0;  ///< Largest coordinate of a correction below which it is none.
    double settled = 0;  ///< A whole correction below so many min_correction, and a gradient below
                         ///< so many tolerances, are an end, too; 0 for no such rule.
    double bound =
        std::numeric_limits<double>::infinity();  ///< A coordinate that goes farther than
                                                  ///< that from the start is a failure.
    int max_astray = 0;  ///< So many corrections in a row that go farther than that are one, too; 0
                         ///< for no such rule.
    double arrival = 0;  ///< How near to its place a prescribed point has arrived.
    int max_iterations = 150;
    bool may_stop_short = false;  ///< Whether to have taken that many, or to find no decrease
                                  ///< behind the first, is as good an end as any.
    bool extends_steps = false;   ///< Whether a whole step may go on along its line.
    std::optional<NewtonStart> start = {};  ///< If not that of the first point.
};

struct NewtonReport {
    bool has_converged = false;
    std::string failure_reason;       ///< Empty if it has.
    bool has_blocked_points = false;  ///< Prescribed points could not get to their places.
    int iterations = 0;               ///< Linear solves.
    double residual = 0;  ///< Gradient at the end over that at the start, by the norm in which more
                          ///< is left; 0 if it ended by a negligible correction.
};

/// Minimizes a function by Newton's method with line search, from x, where the result goes.
///
/// Steps stay where the function is finite. They are halved until the value falls by a part of what
/// the slope promises, or, where that drowns in rounding, until the gradient does
/// [nocedal2006, 3.1]. While prescribed points are on their way to their places the value may rise.
///
/// At kinks the lowest point has no vanishing gradient. There the method ends where the gradient is
/// below a tenth of that at the start, and either a step that had to be cut gains almost nothing or
/// the gradient has not become less for long.
template <int Dim>
[[nodiscard]] NewtonReport newton(Objective<Dim>& function,
                                  const NewtonOptions& options,
                                  Positions<Dim>& x);

/// The first iteration alone, taken whole: x + step.
template <int Dim>
[[nodiscard]] NewtonReport newton_step(Objective<Dim>& function, Positions<Dim>& x);

}  // namespace pent::simulator
