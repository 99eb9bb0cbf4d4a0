#pragma once

#include <pent/contact/barrier.h>
#include <pent/contact/penalty.h>

#include <variant>

namespace pent::contact {

/// Solid below a hyperplane: {x : normal . x < offset}.
template <int Dim>
struct HalfSpace {
    Vector<Dim> normal;  ///< Unit length, out of the solid.
    double offset = 0;   ///< m.
};

/// A solid ball; bodies stay outside.
template <int Dim>
struct Ball {
    Vector<Dim> center;  ///< m.
    double radius = 0;   ///< m, > 0.
};

/// A hollow ball in a solid; bodies stay inside.
template <int Dim>
struct Cavity {
    Vector<Dim> center;  ///< m.
    double radius = 0;   ///< m, > 0.
};

/// Half a hollow ball in solid ground: the ground is the half-space below the rim, the bowl is dug
/// into it. What goes over the rim lies on the ground beside it.
template <int Dim>
struct Bowl {
    Vector<Dim> center;  ///< Of the ball and of its rim, m.
    double radius = 0;   ///< m, > 0.
    Vector<Dim> up;      ///< Unit length, out of the ground.
};

/// Something that does not move and has no mesh.
template <int Dim>
using Obstacle = std::variant<HalfSpace<Dim>, Ball<Dim>, Cavity<Dim>, Bowl<Dim>>;

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
