#pragma once

#include <pent/mesher/solid.h>
#include <pent/simplex_mesh.h>

#include <cstdint>
#include <functional>

namespace pent::mesher {

/// Where the middle of an edge goes whose ends may be on a surface; the middle itself if they are
/// not on the same one.
template <int Dim>
using OntoSurface = std::function<Eigen::Matrix<double, Dim, 1>(
    const Eigen::Matrix<double, Dim, 1>& from, const Eigen::Matrix<double, Dim, 1>& to)>;

/// Onto the sphere of this radius around the origin, m.
[[nodiscard]] OntoSurface<3> onto_sphere(double radius);

/// Onto all smooth pieces of the boundary that both ends are on: an edge along a ridge stays on it.
/// A middle that would end off the boundary stays.
[[nodiscard]] OntoSurface<4> onto_boundary(const Solid& solid);

struct CurveReport {
    std::int64_t moved = 0;    ///< Middles.
    std::int64_t limited = 0;  ///< Middles that would fold a cell on the surface.
    double farthest = 0;       ///< m.
};

/// Moves the middles of boundary edges onto the surface that the boundary stands for, so that
/// quadratic cells are curved (isoparametric) there. Where a quadratic cell would be folded at one
/// of its nodes or points, or one of its linear cells inverted, its middles go a half, a quarter or
/// an eighth of their ways, or stay: `limited` counts them.
///
/// @param straight   A mesh; cells of positive volume.
/// @param quadratic  What make_quadratic() made of it.
template <int Dim>
CurveReport curve_boundary(const SimplexMesh<Dim>& straight,
                           const OntoSurface<Dim>& onto,
                           SimplexMesh<Dim>& quadratic);

}  // namespace pent::mesher
