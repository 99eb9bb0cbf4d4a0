#pragma once

#include <pent/simulator/motion.h>
#include <pent/simulator/selection.h>

#include <limits>
#include <string>
#include <vector>

namespace pent::simulator {

/// Prescribes the motion of some vertices of a body, selected on placed positions at t = 0, in all
/// steps that begin at `from` or later and before `to`; they are free in all others. One that
/// begins later than the scene takes the vertices on from where they are then.
struct Constraint {
    std::string body;
    std::vector<Selection> select;  ///< A union.
    /// Each takes the vertices on from where those before it have them; none holds them still. A
    /// motion begins no sooner than the constraint.
    std::vector<Motion> motion;
    double from = 0;                                      ///< s, >= 0.
    double to = std::numeric_limits<double>::infinity();  ///< s, > from.
    std::string source = {};  ///< Where its selection stands in a scene file; as Body::source.
};

}  // namespace pent::simulator
