#pragma once

#include <pent/mesher/solid.h>
#include <pent/simplex_mesh.h>

#include <cstdint>
#include <functional>

namespace pent::mesher {

/// Where on a curved surface the midpoint of an edge belongs, by the two ends of the edge; the
/// midpoint itself if the ends are not on one piece of that surface.
template <int Dim>
using OntoSurface = std::function<Eigen::Matrix<double, Dim, 1>(
    const Eigen::Matrix<double, Dim, 1>& from, const Eigen::Matrix<double, Dim, 1>& to)>;

/// Onto the sphere of this radius around the origin, m.
[[nodiscard]] OntoSurface<3> onto_sphere(double radius);

/// Onto all smooth pieces of the boundary that both ends are on at once, so that the midpoint of an
/// edge along a ridge stays on the ridge. One that would end off the boundary is not moved.
[[nodiscard]] OntoSurface<4> onto_boundary(const Solid& solid);

struct CurveReport {
    std::int64_t moved = 0;    ///< Midpoints of edges.
    std::int64_t limited = 0;  ///< Midpoints that go less far, since a cell would fold otherwise.
    double farthest = 0;       ///< The longest way of one, m.
};

/// Moves the midpoints of boundary edges onto the surface that the boundary approximates, so that
/// quadratic cells are curved (isoparametric) there. Where the Jacobian of a quadratic cell would
/// not be positive at a node or an integration point, or one of its linear children inverted, its
/// midpoints go a half, a quarter or an eighth of their ways, or stay: `limited` counts them.
///
/// @param straight   A mesh; cells of positive volume.
/// @param quadratic  What make_quadratic() made of it.
template <int Dim>
CurveReport curve_boundary(const SimplexMesh<Dim>& straight,
                           const OntoSurface<Dim>& onto,
                           SimplexMesh<Dim>& quadratic);

}  // namespace pent::mesher
