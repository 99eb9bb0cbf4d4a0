#pragma once

#include <Eigen/Core>

#include <variant>

namespace pent {

/// Solid below a hyperplane: {x : normal . x < offset}.
template <int Dim>
struct HalfSpace {
    Eigen::Matrix<double, Dim, 1> normal;  ///< Unit length, out of the solid.
    double offset = 0;                     ///< m.
};

/// A solid ball; bodies stay outside.
template <int Dim>
struct Ball {
    Eigen::Matrix<double, Dim, 1> center;  ///< m.
    double radius = 0;                     ///< m, > 0.
};

/// A hollow ball in a solid; bodies stay inside.
template <int Dim>
struct Cavity {
    Eigen::Matrix<double, Dim, 1> center;  ///< m.
    double radius = 0;                     ///< m, > 0.
};

/// Half a hollow ball in solid ground: the ground is the half-space below the rim, the bowl is dug
/// into it. What goes over the rim lies on the ground beside it.
template <int Dim>
struct Bowl {
    Eigen::Matrix<double, Dim, 1> center;  ///< Of the ball and of its rim, m.
    double radius = 0;                     ///< m, > 0.
    Eigen::Matrix<double, Dim, 1> up;      ///< Unit length, out of the ground.
};

/// Something solid that has no mesh.
template <int Dim>
using Obstacle = std::variant<HalfSpace<Dim>, Ball<Dim>, Cavity<Dim>, Bowl<Dim>>;

}  // namespace pent
