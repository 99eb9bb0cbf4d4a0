#include "pent/contact/obstacles.h"

#include "filter.h"

#include <pent/error.h>

#include <cmath>
#include <string>

namespace pent::contact {

namespace {

// Distance, gradient and Hessian at a point. The Hessian is `sideways` times the projection normal
// to both `normal` and `tangent`, plus `along_tangent` times that on the tangent.
template <int Dim>
struct Geometry {
    double distance = 0;
    Vector<Dim> normal;
    Vector<Dim> tangent = Vector<Dim>::Zero();  // unit length, or zero if the surface is round
    double along_tangent = 0;
    double sideways = 0;

    [[nodiscard]] Eigen::Matrix<double, Dim, Dim> combine(double n, double t, double s) const {
        Eigen::Matrix<double, Dim, Dim> sum = (n - s) * normal * normal.transpose();
        sum += (t - s) * tangent * tangent.transpose();
        sum.diagonal().array() += s;
        return sum;
    }
};

template <int Dim>
Geometry<Dim> geometry(const HalfSpace<Dim>& plane, const Vector<Dim>& point) {
    return {.distance = plane.normal.dot(point) - plane.offset, .normal = plane.normal};
}

template <int Dim>
Geometry<Dim> geometry(const Ball<Dim>& ball, const Vector<Dim>& point) {
    const Vector<Dim> from_center = point - ball.center;
    const double r = from_center.norm();
    if (r == 0) {
        return {.distance = -ball.radius, .normal = Vector<Dim>::Unit(0)};
    }
    return {.distance = r - ball.radius, .normal = from_center / r, .sideways = 1 / r};
}

template <int Dim>
Geometry<Dim> geometry(const Cavity<Dim>& cavity, const Vector<Dim>& point) {
    Geometry<Dim> ball = geometry(Ball<Dim>{cavity.center, cavity.radius}, point);
    ball.distance = -ball.distance;
    ball.normal = -ball.normal;
    ball.sideways = -ball.sideways;
    return ball;
}

// Above the bowl: the nearest point of the ground is on the rim.
template <int Dim>
Geometry<Dim> rim(const Bowl<Dim>& bowl, const Vector<Dim>& level, double height) {
    const double rho = level.norm();
    Vector<Dim> outward = Vector<Dim>::Zero();  // in the plane of the rim
    if (rho > 0) {
        outward = level / rho;
    } else {
        int axis = 0;
        bowl.up.cwiseAbs().minCoeff(&axis);
        outward = Vector<Dim>::Unit(axis);
        outward = (outward - bowl.up.dot(outward) * bowl.up).normalized();
    }
    const Vector<Dim> from_rim = height * bowl.up + (rho - bowl.radius) * outward;
    const double distance = from_rim.stableNorm();  // above 0: the point is over the opening
    Geometry<Dim> result{.distance = distance, .normal = from_rim / distance};
    if (rho > 0) {
        result.tangent = (height * outward - (rho - bowl.radius) * bowl.up) / distance;
        result.along_tangent = 1 / distance;
        result.sideways = (rho - bowl.radius) / (distance * rho);
    }
    return result;
}

template <int Dim>
Geometry<Dim> geometry(const Bowl<Dim>& bowl, const Vector<Dim>& point) {
    const Vector<Dim> from_center = point - bowl.center;
    const double height = bowl.up.dot(from_center);
    const Vector<Dim> level = from_center - height * bowl.up;
    const bool is_beside = level.norm() >= bowl.radius;
    if (height > 0 && !is_beside) {
        return rim(bowl, level, height);
    }
    // Below the rim, in the hollow or under it, the wall; beside the bowl, the ground, if nearer.
    if (is_beside && (height > 0 || -height < from_center.norm() - bowl.radius)) {
        return {.distance = height, .normal = bowl.up};
    }
    return geometry(Cavity<Dim>{bowl.center, bowl.radius}, point);
}

template <int Dim>
Geometry<Dim> geometry_of(const Obstacle<Dim>& obstacle, const Vector<Dim>& point) {
    return std::visit([&](const auto& shape) { return geometry(shape, point); }, obstacle);
}

template <int Dim>
Response<Dim> respond(
    const Geometry<Dim>& at, double energy, double slope, double curvature, Filter filter) {
    Response<Dim> response;
    response.energy = energy;
    response.gradient = slope * at.normal;
    response.hessian =
        at.combine(filtered(curvature, filter), filtered(slope * at.along_tangent, filter),
                   filtered(slope * at.sideways, filter));
    return response;
}

void require(bool is_right, const char* name, const char* expected) {
    if (!is_right) {
        throw Error(std::string(name) + ": " + expected);
    }
}

template <int Dim>
void check_unit(const Vector<Dim>& vector, const char* name, const char* expected) {
    require(std::abs(vector.norm() - 1) <= 1e-9, name, expected);
}

template <typename Round>
void check_round(const Round& round, const char* name) {
    require(round.center.allFinite(), name, "the center is not finite");
    require(std::isfinite(round.radius) && round.radius > 0, name,
            "the radius is not a number above 0");
}

template <int Dim>
void check_shape(const HalfSpace<Dim>& plane, const char* name) {
    check_unit<Dim>(plane.normal, name, "the normal is not of unit length");
    require(std::isfinite(plane.offset), name, "the offset is not finite");
}

template <int Dim>
void check_shape(const Ball<Dim>& ball, const char* name) {
    check_round(ball, name);
}

template <int Dim>
void check_shape(const Cavity<Dim>& cavity, const char* name) {
    check_round(cavity, name);
}

template <int Dim>
void check_shape(const Bowl<Dim>& bowl, const char* name) {
    check_round(bowl, name);
    check_unit<Dim>(bowl.up, name, "the up vector is not of unit length");
}

}  // namespace

template <int Dim>
double signed_distance(const Obstacle<Dim>& obstacle, const Vector<Dim>& point) {
    return geometry_of(obstacle, point).distance;
}

template <int Dim>
Vector<Dim> signed_distance_gradient(const Obstacle<Dim>& obstacle, const Vector<Dim>& point) {
    return geometry_of(obstacle, point).normal;
}

template <int Dim>
Eigen::Matrix<double, Dim, Dim> signed_distance_hessian(const Obstacle<Dim>& obstacle,
                                                        const Vector<Dim>& point) {
    const Geometry<Dim> at = geometry_of(obstacle, point);
    return at.combine(0, at.along_tangent, at.sideways);
}

template <int Dim>
Response<Dim> obstacle_response(const Obstacle<Dim>& obstacle,
                                const Vector<Dim>& point,
                                const Penalty& penalty,
                                Filter filter) {
    const Geometry<Dim> at = geometry_of(obstacle, point);
    return respond<Dim>(at, penalty_energy(at.distance, penalty),
                        penalty_slope(at.distance, penalty),
                        penalty_curvature(at.distance, penalty), filter);
}

template <int Dim>
Response<Dim> obstacle_response(const Obstacle<Dim>& obstacle,
                                const Vector<Dim>& point,
                                const Barrier& barrier,
                                Filter filter) {
    const Geometry<Dim> at = geometry_of(obstacle, point);
    return respond<Dim>(at, barrier_energy(at.distance, barrier),
                        barrier_slope(at.distance, barrier),
                        barrier_curvature(at.distance, barrier), filter);
}

template <int Dim>
void check(const Obstacle<Dim>& obstacle, const char* name) {
    std::visit([&](const auto& shape) { check_shape(shape, name); }, obstacle);
}

template double signed_distance<3>(const Obstacle<3>&, const Vector<3>&);
template Vector<3> signed_distance_gradient<3>(const Obstacle<3>&, const Vector<3>&);
template Eigen::Matrix<double, 3, 3> signed_distance_hessian<3>(const Obstacle<3>&,
                                                                const Vector<3>&);
template Response<3> obstacle_response<3>(const Obstacle<3>&,
                                          const Vector<3>&,
                                          const Penalty&,
                                          Filter);
template Response<3> obstacle_response<3>(const Obstacle<3>&,
                                          const Vector<3>&,
                                          const Barrier&,
                                          Filter);
template void check<3>(const Obstacle<3>&, const char*);
template double signed_distance<4>(const Obstacle<4>&, const Vector<4>&);
template Vector<4> signed_distance_gradient<4>(const Obstacle<4>&, const Vector<4>&);
template Eigen::Matrix<double, 4, 4> signed_distance_hessian<4>(const Obstacle<4>&,
                                                                const Vector<4>&);
template Response<4> obstacle_response<4>(const Obstacle<4>&,
                                          const Vector<4>&,
                                          const Penalty&,
                                          Filter);
template Response<4> obstacle_response<4>(const Obstacle<4>&,
                                          const Vector<4>&,
                                          const Barrier&,
                                          Filter);
template void check<4>(const Obstacle<4>&, const char*);

}  // namespace pent::contact
