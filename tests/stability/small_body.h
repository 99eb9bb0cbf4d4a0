#pragma once

#include "extremes.h"

#include <pent/error.h>
#include <pent/simulator/simulation.h>

// What all the tables have in common: the small body of a case, its scene, and how outcomes are
// judged.

namespace pent::stability {

/// A bar along x, 4 axes: along, two across, and the layers; or a single pentachoron, whose corner
/// 4 is the only one above w = 0. For quadratic elements with every edge cut in two.
[[nodiscard]] SimplexMesh<4> mesh_of(const Extreme& extreme);

/// One body, and a second beside it where their stiffness differs; nothing held, no gravity.
[[nodiscard]] simulator::Scene scene_of(const Extreme& extreme, simulator::Precision precision);

/// Holds the low end of every body along x; of a single pentachoron, the facet at w = 0.
void hold_ends(simulator::Scene& scene,
               const Extreme& extreme,
               const std::vector<simulator::Spin>& spins);

/// Whether positions and velocities of all bodies are finite.
[[nodiscard]] bool is_finite(const simulator::Simulation<4>& simulation);

/// Takes steps to the end. Right, or Reported from the first that was not taken as told, or with
/// elements that are inverted at the end; Wrong if what a step leaves is not finite.
[[nodiscard]] Outcome step_all(simulator::Simulation<4>& simulation, int steps);

/// Right if the error is within bound(), else Wrong.
[[nodiscard]] Outcome judge(double error, simulator::Precision precision);

/// Refused where the action throws an Error.
template <typename Action>
[[nodiscard]] Outcome guarded(const Action& action) {
    try {
        return action();
    } catch (const Error& refusal) {
        return {.kind = Outcome::Kind::Refused, .error = 0, .reason = refusal.what()};
    }
}

}  // namespace pent::stability
