#pragma once

#include <pent/contact/surface.h>

namespace pent::contact {

/// The vector normal to the columns, of which there are one less than dimensions: n with
/// n . x = det[columns, x].
[[nodiscard]] Vector<2> normal_to(const Eigen::Matrix<double, 2, 1>& edges);
[[nodiscard]] Vector<3> normal_to(const Eigen::Matrix<double, 3, 2>& edges);
[[nodiscard]] Vector<4> normal_to(const Eigen::Matrix<double, 4, 3>& edges);

/// Outward normal of a facet: length (Dim - 1)! times its area, so zero where it has collapsed.
///
/// @param corners  In the outward order.
template <int Dim>
[[nodiscard]] Vector<Dim> facet_normal(const Corners<Dim, Dim>& corners);

/// Unit outward normals at surface.vertices, Dim x vertices: the area-weighted mean of the facets
/// there; zero where they cancel. Parallel.
template <int Dim>
[[nodiscard]] Positions<Dim> vertex_normals(const Surface<Dim>& surface,
                                            const PositionsView<Dim>& positions);

}  // namespace pent::contact
