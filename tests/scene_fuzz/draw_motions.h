#pragma once

#include "keys.h"
#include "plan.h"

/// Selections and motions, of constraints and of all else that has them.
namespace pent::scene_fuzz {

extern const Keys kSpin;
extern const Keys kConstraint;

/// Motions, or the word for none.
[[nodiscard]] Json draw_motion(Random& random, const Plan& plan);

/// By any angles.
[[nodiscard]] Json draw_turns(Random& random, const Plan& plan);

[[nodiscard]] Json draw_selections(Random& random, const Plan& plan);

/// Half of a body along an axis: of its box, so never nothing.
[[nodiscard]] Json half_space_selection(Random& random, const Plan& plan);

/// A moment in the first half of a run, and one behind it.
[[nodiscard]] Json early(Random& random, const Plan& plan);
[[nodiscard]] Json late(Random& random, const Plan& plan);

}  // namespace pent::scene_fuzz
