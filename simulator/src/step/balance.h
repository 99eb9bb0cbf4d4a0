#pragma once

#include "model/held_vertices.h"

#include <pent/simulator/step_report.h>

#include <vector>

namespace pent::simulator {

/// sum m v, kg m/s.
template <int Dim>
[[nodiscard]] std::vector<double> momentum(const Eigen::VectorXd& masses,
                                           const Positions<Dim>& velocities);

/// sum m (x ^ v) about the origin, kg m^2/s: a number for each plane, in the order xy, xz, xw, yz,
/// yw, zw; above 0 where it turns the first axis towards the second.
template <int Dim>
[[nodiscard]] std::vector<double> angular_momentum(const Eigen::VectorXd& masses,
                                                   const Positions<Dim>& positions,
                                                   const Positions<Dim>& velocities);

/// Minus all forces (N, without inertia and damping) that act on vertices which are held now; 0 at
/// all others.
template <int Dim>
[[nodiscard]] Positions<Dim> reactions(const HeldVertices<Dim>& held, const Positions<Dim>& forces);

/// The force and moment with which each constraint holds its vertices: the sums of their reactions.
template <int Dim>
[[nodiscard]] std::vector<ConstraintSummary> constraint_summaries(const HeldVertices<Dim>& held,
                                                                  const Positions<Dim>& positions,
                                                                  const Positions<Dim>& forces);

}  // namespace pent::simulator
