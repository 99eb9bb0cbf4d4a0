#pragma once

#include <pent/contact/surface.h>
#include <pent/obstacle.h>

#include <string>
#include <vector>

namespace pent::contact {

// The shapes are part of the format: files of runs have them, too.
using pent::Ball;
using pent::Bowl;
using pent::Cavity;
using pent::Cuboid;
using pent::HalfSpace;
using pent::ObstacleShape;
using pent::Repels;
using pent::ShapeField;

/// Signed distance of a point to the surface of an obstacle, negative in the solid, and its
/// derivatives. It is exact, so that its gradient has length 1.
///
/// Its Hessian has the eigenvalue `along_tangent` on the tangent, and `sideways` on what is normal
/// to tangent and gradient within the given axes.
template <int Dim>
struct SignedDistance {
    double value = 0;                           ///< m.
    Vector<Dim> gradient;                       ///< A unit vector, out of the solid.
    Vector<Dim> tangent = Vector<Dim>::Zero();  ///< Unit length; zero where all are alike.
    double along_tangent = 0;                   ///< Curvature, 1/m.
    double sideways = 0;                        ///< Curvature, 1/m.
    Block<Dim> axes = Block<Dim>::Identity();   ///< Projects on those along which it may bend.

    /// n g g^T + t on the tangent + s sideways.
    [[nodiscard]] Block<Dim> combine(double n, double t, double s) const {
        Block<Dim> sum = (n - s) * gradient * gradient.transpose();
        sum += (t - s) * tangent * tangent.transpose();
        sum += s * axes;
        return sum;
    }

    /// 1/m, symmetric: normal curvature of the parallel surface through the point.
    [[nodiscard]] Block<Dim> hessian() const { return combine(0, along_tangent, sideways); }
};

/// At a center, where every direction is as good, the gradient is the first axis; above the middle
/// of a bowl, where the whole rim may be nearest, it is towards one point of the rim. The Hessian
/// is zero there.
template <int Dim>
[[nodiscard]] SignedDistance<Dim> signed_distance(const ObstacleShape<Dim>& obstacle,
                                                  const Vector<Dim>& point);

/// Whether the straight way between two points that are no deeper in an obstacle than `depth` goes
/// deeper into it; ways that are deeper by less than an eighth of it may be overlooked.
///
/// @param depth  m, > 0.
template <int Dim>
[[nodiscard]] bool passes_through(const ObstacleShape<Dim>& obstacle,
                                  const Vector<Dim>& from,
                                  const Vector<Dim>& to,
                                  double depth);

[[nodiscard]] inline Repels repels(const auto& obstacle) {
    return std::visit([](const auto& shape) { return shape.kRepels; }, obstacle);
}

/// The core of an obstacle that repels facets: all points within `radius` of these simplices, and
/// what they enclose, are the solid.
template <int Dim>
struct ObstacleCore {
    Surface<Dim> surface;   ///< Of vertices from 0; no faces where the core is a single point.
    Positions<Dim> points;  ///< Of these vertices; none if the obstacle repels vertices.
    double radius = 0;      ///< m, >= 0.
};

template <int Dim>
[[nodiscard]] ObstacleCore<Dim> core_of(const ObstacleShape<Dim>& obstacle);

}  // namespace pent::contact
