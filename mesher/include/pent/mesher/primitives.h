#pragma once

#include <pent/mesher/solid.h>

#include <string>

namespace pent::mesher {

/// The primitives that solids are made of, each around the origin. What is round is so in the first
/// axes, what is straight lies along the last ones. All lengths in m, above 0; an Error for others.

/// |p| <= radius: the glome with its inside, pi^2/2 radius^4.
[[nodiscard]] Solid ball_solid(double radius);

/// Product of intervals.
/// @param size  Edges along x y z w.
[[nodiscard]] Solid box_solid(const Eigen::Vector4d& size);

/// Within a radius of a segment along w: pi^2/2 radius^4 + 4/3 pi radius^3 length.
/// @param length  Of the segment; the whole is 2 radius longer.
[[nodiscard]] Solid capsule_solid(double radius, double length);

/// A ball in xyz times an interval along w: 4/3 pi radius^3 length.
[[nodiscard]] Solid spherinder_solid(double radius, double length);

/// A disk in xy times a rectangle in zw: pi radius^2 size_z size_w.
/// @param size  Edges along z and w.
[[nodiscard]] Solid cubinder_solid(double radius, const Eigen::Vector2d& size);

/// A disk in xy times a disk in zw: pi^2 radius_xy^2 radius_zw^2.
[[nodiscard]] Solid duocylinder_solid(const Eigen::Vector2d& radii);

/// Within tube_radius of a circle in xy: 8/3 pi^2 ring_radius tube_radius^3.
/// @param tube_radius  Below ring_radius.
[[nodiscard]] Solid spheritorus_solid(double ring_radius, double tube_radius);

/// Within tube_radius of a sphere in xyz: 4 pi^2 tube_radius^2 (ring_radius^2 + tube_radius^2 / 4).
/// @param tube_radius  Below ring_radius.
[[nodiscard]] Solid torisphere_solid(double ring_radius, double tube_radius);

/// Within tube_radius of the product of a circle in xy and one in zw:
/// 4 pi^3 ring_xy ring_zw tube_radius^2.
/// @param tube_radius  Below both ring radii.
[[nodiscard]] Solid tiger_solid(const Eigen::Vector2d& ring_radii, double tube_radius);

/// Within tube_radius of a torus in xyz, whose rings are ring_radii[0] and ring_radii[1]:
/// 4 pi^3 ring_radii[0] ring_radii[1] tube_radius^2.
/// @param ring_radii   The second with the tube below the first.
/// @param tube_radius  Below the second ring radius.
[[nodiscard]] Solid ditorus_solid(const Eigen::Vector2d& ring_radii, double tube_radius);

/// The Clifford torus on the sphere of this radius, thickened: within thickness / 2 of it. It is
/// the tiger with both rings radius / sqrt(2): pi^3/2 radius^2 thickness^2.
/// @param thickness  Below sqrt(2) radius.
[[nodiscard]] Solid clifford_torus_solid(double radius, double thickness);

/// The convex regular polytope of 5, 8, 16, 24, 120 or 600 cells.
/// @param radius  Of its vertices.
[[nodiscard]] Solid polytope_solid(int cells, double radius);

/// All points p with normal * p <= offset; without bounds by itself.
/// @param normal  Of any length but 0.
[[nodiscard]] Solid half_space_solid(const Eigen::Vector4d& normal, double offset);

/// Where a formula in x y z w is negative, within a box; its sides are sharp if it reaches them.
/// The syntax is that of muParser: ^ is the power, and sqrt, sin, abs, min, ... are known.
///
/// The function need not be a distance; it should be smooth, with a slope other than 0, where it
/// is 0.
[[nodiscard]] Solid expression_solid(const std::string& formula, const Box4& box);

}  // namespace pent::mesher
