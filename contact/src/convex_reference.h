#pragma once

#include <pent/contact/surface.h>

#include <optional>

namespace pent::contact {

/// Positions of all vertices of a body, near those at rest, at which it is convex: what is convex
/// up to small dents gets these bent out. All its cells are positively oriented there, so they fill
/// it once.
///
/// No value where there are none near rest, as for a body with a notch, a hole or two parts.
///
/// @param surface  Of all the cells, counted from vertex 0.
/// @param cells    Positively oriented at rest.
/// @param rest     Dim x vertices of the body, m.
template <int Dim>
[[nodiscard]] std::optional<Positions<Dim>> convex_reference(const Surface<Dim>& surface,
                                                             const Simplices<Dim + 1>& cells,
                                                             const PositionsView<Dim>& rest);

}  // namespace pent::contact
