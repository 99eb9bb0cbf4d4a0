#pragma once

#include <pent/geometry.h>
#include <pent/simulator/host.h>
#include <pent/simulator/simulation.h>

#include <Eigen/Core>

#include <optional>

namespace pent::simulator {

/// The points origin + t direction, t >= 0.
template <int Dim>
struct Ray {
    Eigen::Matrix<double, Dim, 1> origin;     ///< m.
    Eigen::Matrix<double, Dim, 1> direction;  ///< Of any length but 0.
};

/// What a ray meets.
template <int Dim>
struct Pick {
    BodyPoint<Dim> point;
    Eigen::Matrix<double, Dim, 1> place;  ///< Where it is now, m.
    double distance = 0;                  ///< From the ray's origin, m.
};

/// The point of the bodies, as they are now, that a ray comes to first: its origin, within a body;
/// none if it meets no body. Obstacles do not count.
///
/// A ray that lies in the hyperplane of a slice finds what is seen of the slice along it, so what a
/// pointer is at in a picture. The same for any history; of cells that are equally near the first
/// counts. Takes time like the number of cells.
///
/// Throws an Error unless all numbers are finite and the direction is not 0.
template <int Dim>
[[nodiscard]] std::optional<Pick<Dim>> pick(const Simulation<Dim>& simulation, const Ray<Dim>& ray);

/// The same for the ray's shadow on a hyperplane, along its normal: of a ray in it but for
/// rounding.
///
/// Throws an Error also if the normal is 0, or the ray is along it.
template <int Dim>
[[nodiscard]] std::optional<Pick<Dim>> pick(const Simulation<Dim>& simulation,
                                            const Hyperplane<Dim>& slice,
                                            const Ray<Dim>& ray);

/// Where a point of a body is now, m. Throws an Error unless there are such a body and cell.
template <int Dim>
[[nodiscard]] Eigen::Matrix<double, Dim, 1> place_of(const Simulation<Dim>& simulation,
                                                     const BodyPoint<Dim>& point);

}  // namespace pent::simulator
