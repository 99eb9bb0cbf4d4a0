#pragma once

#include <pent/contact/surface.h>

namespace pent::contact {

/// The same as make_surface(), of a body whose boundary is known.
///
/// @param boundary      As match_facets() has it, indices from 0.
/// @param first_vertex  What to add to them.
template <int Dim>
[[nodiscard]] Surface<Dim> surface_of(Simplices<Dim> boundary, std::uint32_t first_vertex);

}  // namespace pent::contact
