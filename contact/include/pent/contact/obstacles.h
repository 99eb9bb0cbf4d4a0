#pragma once

#include <pent/contact/barrier.h>
#include <pent/contact/penalty.h>
#include <pent/obstacle.h>

namespace pent::contact {

// The shapes are in the format, as files of runs have them, too.
using pent::Ball;
using pent::Bowl;
using pent::Cavity;
using pent::HalfSpace;
using pent::Obstacle;

/// Signed distance of a point to the surface of an obstacle, m; negative in the solid. Exact, so its
/// gradient has length 1 wherever it has one.
template <int Dim>
[[nodiscard]] double signed_distance(const Obstacle<Dim>& obstacle, const Vector<Dim>& point);

/// Gradient: a unit vector, out of the solid.
///
/// At a center, where every direction is as good, it is the first axis; above the middle of a
/// bowl, where the whole rim may be nearest, it is towards one point of the rim.
template <int Dim>
[[nodiscard]] Vector<Dim> signed_distance_gradient(const Obstacle<Dim>& obstacle,
                                                   const Vector<Dim>& point);

/// Hessian, 1/m, symmetric: normal curvature of the parallel surface through the point. Zero at the
/// points named above.
template <int Dim>
[[nodiscard]] Eigen::Matrix<double, Dim, Dim> signed_distance_hessian(const Obstacle<Dim>& obstacle,
                                                                      const Vector<Dim>& point);

/// Response of a point to an obstacle, at any depth: psi'' n n^T + psi' H, with the eigenvalues of H
/// in closed form and filtered.
template <int Dim>
[[nodiscard]] Response<Dim> obstacle_response(const Obstacle<Dim>& obstacle,
                                              const Vector<Dim>& point,
                                              const Penalty& penalty,
                                              Filter filter);

/// The same for a barrier; the point must be further than its separation out of the solid.
template <int Dim>
[[nodiscard]] Response<Dim> obstacle_response(const Obstacle<Dim>& obstacle,
                                              const Vector<Dim>& point,
                                              const Barrier& barrier,
                                              Filter filter);

/// Throws an Error, beginning with `name`, unless numbers are finite, radii > 0 and normals of unit
/// length (to 1e-9).
template <int Dim>
void check(const Obstacle<Dim>& obstacle, const char* name);

}  // namespace pent::contact
