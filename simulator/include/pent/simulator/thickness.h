#pragma once

#include <pent/simplex_mesh.h>

namespace pent::simulator {

/// The least extent of a body, m, along the coordinate axes and along its principal axes (those of
/// the covariance of its vertices).
///
/// A plate is as thick as it is, however it is turned. The result is never less than the body is
/// wide in its narrowest direction, nor more than the shortest side of the upright box around it;
/// of a body of equal sides, whose principal axes are not unique, it may be anything between.
///
/// @param positions  Of the vertices, m; at least one, finite.
template <int Dim>
[[nodiscard]] double thickness(const Positions<Dim>& positions);

}  // namespace pent::simulator
