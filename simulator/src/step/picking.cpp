#include "model/rotation.h"

#include <pent/dimensions.h>
#include <pent/error.h>
#include <pent/simulator/picking.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace pent::simulator {

namespace {

template <int Dim>
using Corners = Eigen::Matrix<double, Dim, Dim + 1>;

template <int Dim>
using Weights = Eigen::Matrix<double, Dim + 1, 1>;

template <int Dim>
Corners<Dim> corners_of(const Simulation<Dim>& simulation, int body, Eigen::Index cell) {
    const auto& cells = simulation.mesh(body).cells;
    const auto positions = simulation.positions(body);
    Corners<Dim> corners;
    for (int i = 0; i <= Dim; ++i) {
        corners.col(i) = positions.col(cells(i, cell));
    }
    return corners;
}

// The interval of a ray on which a number that is `value` at its origin and changes by `slope` is
// not negative.
struct Span {
    double begin = 0;
    double end = std::numeric_limits<double>::infinity();

    void keep_positive(double value, double slope) {
        if (slope > 0) {
            begin = std::max(begin, -value / slope);
        } else if (slope < 0) {
            end = std::min(end, -value / slope);
        } else if (value < 0) {
            end = -1;
        }
    }
    [[nodiscard]] bool is_empty() const { return !(begin <= end); }
};

// Whether a ray meets the box around a cell before t = `most`.
template <int Dim>
bool meets_box(const Corners<Dim>& corners, const Ray<Dim>& ray, double most) {
    Span span{0, most};
    for (int axis = 0; axis < Dim; ++axis) {
        span.keep_positive(ray.origin[axis] - corners.row(axis).minCoeff(), ray.direction[axis]);
        span.keep_positive(corners.row(axis).maxCoeff() - ray.origin[axis], -ray.direction[axis]);
    }
    return !span.is_empty();
}

// Cells are larger by this part of their size, so that no ray goes between two of them.
constexpr double kRounding = 1e-12;

// Whether a ray meets a cell; where it enters it, by barycentric coordinates, which are linear
// along it.
template <int Dim>
bool enters(const Corners<Dim>& corners, const Ray<Dim>& ray, double& t, Weights<Dim>& weights) {
    const Matrix<Dim> edges = corners.template rightCols<Dim>().colwise() - corners.col(0);
    const Eigen::PartialPivLU<Matrix<Dim>> factors(edges);
    Weights<Dim> values;
    Weights<Dim> slopes;
    values.template tail<Dim>() = factors.solve(ray.origin - corners.col(0));
    slopes.template tail<Dim>() = factors.solve(ray.direction);
    values[0] = 1 - values.template tail<Dim>().sum();
    slopes[0] = -slopes.template tail<Dim>().sum();
    if (!values.allFinite() || !slopes.allFinite()) {  // of a cell without volume
        return false;
    }
    Span span;
    for (int i = 0; i <= Dim; ++i) {
        span.keep_positive(values[i] + kRounding, slopes[i]);
    }
    t = span.begin;
    weights = (values + t * slopes).cwiseMax(0);
    weights /= weights.sum();
    return !span.is_empty();
}

// The vector at unit length, however large or small it is.
template <int Dim>
Vector<Dim> unit(const Vector<Dim>& vector) {
    return (vector / vector.cwiseAbs().maxCoeff()).normalized();
}

// The ray with a direction of unit length. Throws an Error if it has no direction.
template <int Dim>
Ray<Dim> checked(const Ray<Dim>& ray) {
    if (!ray.origin.allFinite() || !ray.direction.allFinite() || ray.direction.isZero(0)) {
        throw Error("a ray needs a finite origin and a finite direction that is not 0");
    }
    return {.origin = ray.origin, .direction = unit<Dim>(ray.direction)};
}

}  // namespace

template <int Dim>
std::optional<Pick<Dim>> pick(const Simulation<Dim>& simulation, const Ray<Dim>& any_ray) {
    const Ray<Dim> ray = checked(any_ray);
    Pick<Dim> first;
    double nearest = std::numeric_limits<double>::infinity();
    for (int body = 0; body < simulation.body_count(); ++body) {
        for (Eigen::Index cell = 0; cell < simulation.mesh(body).cell_count(); ++cell) {
            const Corners<Dim> corners = corners_of(simulation, body, cell);
            double t = 0;
            Weights<Dim> weights;
            if (meets_box<Dim>(corners, ray, nearest) && enters<Dim>(corners, ray, t, weights)
                && t < nearest) {
                nearest = t;
                first.point = {body, cell, weights};
                first.place = corners * weights;
            }
        }
    }
    if (std::isinf(nearest)) {
        return std::nullopt;
    }
    first.distance = nearest;
    return first;
}

template <int Dim>
std::optional<Pick<Dim>> pick(const Simulation<Dim>& simulation,
                              const Hyperplane<Dim>& slice,
                              const Ray<Dim>& any_ray) {
    const Ray<Dim> ray = checked(any_ray);
    if (!slice.normal.allFinite() || slice.normal.isZero(0) || !std::isfinite(slice.offset)) {
        throw Error("a hyperplane needs a finite offset and a finite normal that is not 0");
    }
    const Vector<Dim> normal = unit<Dim>(slice.normal);
    const double size = normal.dot(slice.normal);
    Ray<Dim> in_slice = ray;
    in_slice.origin -= (normal.dot(ray.origin) - slice.offset / size) * normal;
    in_slice.direction -= normal.dot(ray.direction) * normal;
    constexpr double kParallel = 1e-9;  // what rounding may leave of a direction along the normal
    if (in_slice.direction.norm() <= kParallel) {
        throw Error(
            "the ray is along the normal of the slice and meets it in one point; expected"
            " one that lies in it");
    }
    return pick(simulation, in_slice);
}

template <int Dim>
Eigen::Matrix<double, Dim, 1> place_of(const Simulation<Dim>& simulation,
                                       const BodyPoint<Dim>& point) {
    if (point.body < 0 || point.body >= simulation.body_count() || point.cell < 0
        || point.cell >= simulation.mesh(point.body).cell_count()) {
        throw Error("there is no cell " + std::to_string(point.cell) + " of a body "
                    + std::to_string(point.body));
    }
    return corners_of(simulation, point.body, point.cell) * point.weights;
}

#define PENT_INSTANTIATE(Dim)                                                              \
    template std::optional<Pick<Dim>> pick(const Simulation<Dim>&, const Ray<Dim>&);       \
    template std::optional<Pick<Dim>> pick(const Simulation<Dim>&, const Hyperplane<Dim>&, \
                                           const Ray<Dim>&);                               \
    template Eigen::Matrix<double, Dim, 1> place_of(const Simulation<Dim>&, const BodyPoint<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
