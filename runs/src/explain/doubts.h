#pragma once

#include "simulator_names.h"

#include <pent/runs/run.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pent::runs {

/// What makes a scene, or how it ran, look as if something else had been meant: a line each, for
/// people.

/// Penetration beyond this part of the thinnest extent of a body is said to be deep.
inline constexpr double kDeep = 0.1;

/// Of the thinnest body, m.
template <int Dim>
[[nodiscard]] double least_thickness(const Simulation<Dim>& simulation);

/// Units that do not fit one another: distances of contact or obstacles above a tenth of a body,
/// waves that cross a body in 1e-4 of a step or in 1e4 steps, bodies of micrograms.
template <int Dim>
[[nodiscard]] std::vector<std::string> doubts_of_units(const Scene& scene,
                                                       const Simulation<Dim>& simulation);

/// Bodies that overlap, or begin inside an obstacle, by more than a tenth of the distance at which
/// contact begins.
///
/// @param simulation  At its start.
template <int Dim>
[[nodiscard]] std::vector<std::string> overlaps_at_start(const Scene& scene,
                                                         const Simulation<Dim>& simulation);

/// Bodies that penalties are too soft for: by weight, or by the speed with which they arrive after
/// the fall that gravity gives them, they would go deep. With the stiffness that would do;
/// docs/contact.md has the formulas. Nothing for a barrier.
///
/// @param boundary_vertices  One a body: how many of its vertices are on its boundary.
template <int Dim>
[[nodiscard]] std::vector<std::string> soft_contacts(
    const Scene& scene,
    const Simulation<Dim>& simulation,
    const std::vector<std::int64_t>& boundary_vertices);

/// Of a run in which something went deep: how deep, and what would do, more steps where it went
/// there in one, else stiffness; else empty.
[[nodiscard]] std::string deep_penetration(const Scene& scene, const RunReport& report);

/// What to try after a step that failed for a reason.
///
/// @param doubts  Of units: what is wrong there shows first.
[[nodiscard]] std::string remedy(const Scene& scene,
                                 const std::string& failure,
                                 const std::vector<std::string>& doubts);

}  // namespace pent::runs
