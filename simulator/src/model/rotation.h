#pragma once

#include <pent/simulator/scene.h>

#include <Eigen/Core>

#include <vector>

namespace pent::simulator {

template <int Dim>
using Vector = Eigen::Matrix<double, Dim, 1>;
template <int Dim>
using Matrix = Eigen::Matrix<double, Dim, Dim>;

/// Rotation in a plane by an angle in radians: takes axis `from` towards axis `to`.
template <int Dim>
[[nodiscard]] Matrix<Dim> plane_rotation(const Plane& plane, double angle);

/// All of them, one after the other.
template <int Dim>
[[nodiscard]] Matrix<Dim> rotation_of(const std::vector<Turn>& turns);

/// The rigid motion that a motion amounts to at one moment: X goes to
template <int Dim>
struct Pose {
    Matrix<Dim> rotation;
    Vector<Dim> shift;     ///< m.
    Matrix<Dim> rate;      ///< d rotation / dt, 1/s.
    Vector<Dim> velocity;  ///< m/s.
};

/// Pose of a motion at a time in s, in closed form; at rest before `from`, and behind `to` or the
/// last keyframe. At either of these the velocity is the one before that time, and at 0 the one
/// with which the motion begins.
template <int Dim>
[[nodiscard]] Pose<Dim> pose_at(const Motion& motion, double time);

}  // namespace pent::simulator
