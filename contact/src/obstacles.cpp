#include "pent/contact/obstacles.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

namespace pent::contact {

namespace {

template <int Dim>
SignedDistance<Dim> distance_to(const HalfSpace<Dim>& plane, const Vector<Dim>& point) {
    return {.value = plane.normal.dot(point) - plane.offset, .gradient = plane.normal};
}

template <int Dim>
SignedDistance<Dim> distance_to(const Ball<Dim>& ball, const Vector<Dim>& point) {
    const Vector<Dim> from_center = point - ball.center;
    const double r = from_center.norm();
    if (r == 0) {
        return {.value = -ball.radius, .gradient = Vector<Dim>::Unit(0)};
    }
    return {.value = r - ball.radius, .gradient = from_center / r, .sideways = 1 / r};
}

template <int Dim>
SignedDistance<Dim> distance_to(const Cavity<Dim>& cavity, const Vector<Dim>& point) {
    SignedDistance<Dim> ball = distance_to(Ball<Dim>{cavity.center, cavity.radius}, point);
    ball.value = -ball.value;
    ball.gradient = -ball.gradient;
    ball.sideways = -ball.sideways;
    return ball;
}

// A point this near to the axis of a bowl, relative to its distance, has no direction away from it
// but rounding.
constexpr double kOnAxis = 1e-12;

// Above the bowl: the nearest point of the ground is on the rim.
template <int Dim>
SignedDistance<Dim> distance_to_rim(const Bowl<Dim>& bowl,
                                    const Vector<Dim>& level,
                                    double height) {
    // Near the axis what rounding has left along `up` would count: it is taken out.
    const Vector<Dim> across = level - bowl.up.dot(level) * bowl.up;
    const double rho = across.norm();
    const bool is_on_axis = rho <= kOnAxis * (height + bowl.radius);
    Vector<Dim> outward = Vector<Dim>::Zero();  // in the plane of the rim
    if (!is_on_axis) {
        outward = across / rho;
    } else {
        int axis = 0;
        bowl.up.cwiseAbs().minCoeff(&axis);
        outward = Vector<Dim>::Unit(axis);
        outward = (outward - bowl.up.dot(outward) * bowl.up).normalized();
    }
    const Vector<Dim> from_rim = height * bowl.up + (rho - bowl.radius) * outward;
    const double distance = from_rim.stableNorm();  // above 0: the point is over the opening
    SignedDistance<Dim> result{.value = distance, .gradient = from_rim / distance};
    if (!is_on_axis) {
        result.tangent = (height * outward - (rho - bowl.radius) * bowl.up) / distance;
        result.along_tangent = 1 / distance;
        result.sideways = (rho - bowl.radius) / (distance * rho);
    }
    return result;
}

template <int Dim>
SignedDistance<Dim> distance_to(const Bowl<Dim>& bowl, const Vector<Dim>& point) {
    const Vector<Dim> from_center = point - bowl.center;
    const double height = bowl.up.dot(from_center);
    const Vector<Dim> level = from_center - height * bowl.up;
    const bool is_beside = level.norm() >= bowl.radius;
    if (height > 0 && !is_beside) {
        return distance_to_rim(bowl, level, height);
    }
    // Below the rim, in the hollow or under it, the wall; beside the bowl, the ground, if nearer.
    if (is_beside && (height > 0 || -height < from_center.norm() - bowl.radius)) {
        return {.value = height, .gradient = bowl.up};
    }
    return distance_to(Cavity<Dim>{bowl.center, bowl.radius}, point);
}

template <int Dim>
SignedDistance<Dim> distance_to(const Cuboid<Dim>& box, const Vector<Dim>& point) {
    const Vector<Dim> from_center = box.axes.transpose() * (point - box.center);
    const Vector<Dim> beyond = from_center.cwiseAbs() - 0.5 * box.sides;  // the sides, axis by axis
    const Vector<Dim> outside = beyond.cwiseMax(0).cwiseProduct(from_center.cwiseSign());
    const double distance = outside.norm();
    if (distance > 0) {
        const Vector<Dim> bends = (beyond.array() > 0).template cast<double>();
        return {.value = distance,
                .gradient = box.axes * outside / distance,
                .sideways = 1 / distance,
                .axes = box.axes * bends.asDiagonal() * box.axes.transpose()};
    }
    int axis = 0;
    const double depth = beyond.maxCoeff(&axis);
    return {.value = depth, .gradient = (from_center[axis] < 0 ? -1 : 1) * box.axes.col(axis)};
}

template <int Dim>
ObstacleCore<Dim> core_of_shape(const Ball<Dim>& ball) {
    ObstacleCore<Dim> core;
    core.surface.vertices = Simplices<1>::Zero(1, 1);
    core.points = ball.center;
    core.radius = ball.radius;
    return core;
}

template <int Dim>
ObstacleCore<Dim> core_of_shape(const Cuboid<Dim>& box) {
    SimplexMesh<Dim> mesh = to_mesh<Dim>(box);
    ObstacleCore<Dim> core;
    core.surface = make_surface<Dim>(mesh.cells, mesh.vertex_count());
    core.points = std::move(mesh.positions);
    return core;
}

}  // namespace

template <int Dim>
SignedDistance<Dim> signed_distance(const ObstacleShape<Dim>& obstacle, const Vector<Dim>& point) {
    return std::visit([&](const auto& shape) { return distance_to(shape, point); }, obstacle);
}

// Sphere tracing: signed distances change no faster than the point moves, so that no point nearer
// than d to one at distance d is in the solid.
template <int Dim>
bool passes_through(const ObstacleShape<Dim>& obstacle,
                    const Vector<Dim>& from,
                    const Vector<Dim>& to,
                    double depth) {
    const auto above = [&](const Vector<Dim>& point) {
        return signed_distance(obstacle, point).value + depth;
    };
    const double length = (to - from).norm();
    if (!(length > 2 * depth)) {
        return false;  // too short to go in by `depth` and out again
    }
    const double at_end = above(to);
    double height = above(from);
    if (height <= 0 || at_end <= 0) {
        return false;
    }
    double path_length = 0;
    while (height > 0) {
        path_length += std::max(height, depth / 8);
        if (path_length >= length - at_end) {
            return false;
        }
        height = above(from + path_length / length * (to - from));
    }
    return true;
}

template <int Dim>
ObstacleCore<Dim> core_of(const ObstacleShape<Dim>& obstacle) {
    return std::visit(
        [](const auto& shape) {
            if constexpr (std::remove_cvref_t<decltype(shape)>::kRepels == Repels::Facets) {
                return core_of_shape(shape);
            } else {
                return ObstacleCore<Dim>();
            }
        },
        obstacle);
}

#define PENT_INSTANTIATE(Dim)                                                        \
    template SignedDistance<Dim> signed_distance<Dim>(const ObstacleShape<Dim>&,     \
                                                      const Vector<Dim>&);           \
    template bool passes_through<Dim>(const ObstacleShape<Dim>&, const Vector<Dim>&, \
                                      const Vector<Dim>&, double);                   \
    template ObstacleCore<Dim> core_of<Dim>(const ObstacleShape<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
