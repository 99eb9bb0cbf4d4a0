#pragma once

#include <pent/contact/surface.h>
#include <pent/geometry.h>

namespace pent::contact {

/// Unit outward normals at surface.vertices, Dim x vertices: the area-weighted mean of the facets
/// there; zero where they cancel. Parallel.
template <int Dim>
[[nodiscard]] Positions<Dim> vertex_normals(const Surface<Dim>& surface,
                                            const PositionsView<Dim>& positions);

}  // namespace pent::contact
