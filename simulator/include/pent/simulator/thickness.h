#pragma once

#include <pent/simplex_mesh.h>

namespace pent::simulator {

/// Least extent of a body along the axes of space and its own, m: those in which its vertices are
/// spread least, most and between.
///
/// A plate is as thick as it is, however it is turned. The result is never less than the body is
/// wide in its narrowest direction, nor more than the shortest side of the upright box around it;
/// of a body of equal sides, which has no axes of its own, it may be anything between the two.
///
/// @param positions  Of the vertices, m; at least one, finite.
template <int Dim>
[[nodiscard]] double thickness(const Positions<Dim>& positions);

}  // namespace pent::simulator
