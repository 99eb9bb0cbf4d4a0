#include "model/rotation.h"

#include <pent/simulator/placed_mesh.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pent::simulator {

namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180;

}  // namespace

template <int Dim>
Matrix<Dim> plane_rotation(const Plane& plane, double angle) {
    Matrix<Dim> rotation = Matrix<Dim>::Identity();
    rotation(plane.from, plane.from) = std::cos(angle);
    rotation(plane.to, plane.to) = std::cos(angle);
    rotation(plane.from, plane.to) = -std::sin(angle);
    rotation(plane.to, plane.from) = std::sin(angle);
    return rotation;
}

template <int Dim>
SimplexMesh<Dim> place(SimplexMesh<Dim> mesh, const Body& body) {
    const Placement& placement = body.place;
    if (placement.scale != 1) {
        mesh.positions *= placement.scale;
    }
    Matrix<Dim> rotation = Matrix<Dim>::Identity();
    for (const Turn& turn : placement.rotate) {
        rotation = plane_rotation<Dim>(turn.plane, kRadiansPerDegree * turn.degrees) * rotation;
    }
    if (!placement.rotate.empty()) {
        mesh.positions = (rotation * mesh.positions).eval();
        mesh.fibers = (rotation * mesh.fibers).eval();
    }
    const Vector<Dim> translate = placement.translate;
    mesh.positions.colwise() += translate;
    validate(mesh, body.mesh + " (as placed for body \"" + body.name + "\")");
    return mesh;
}

template <int Dim>
Pose<Dim> pose_at(const Motion& motion, double time) {
    const double elapsed = std::clamp(time, motion.from, motion.to) - motion.from;
    const bool is_moving = time >= motion.from && time <= motion.to;
    const Vector<Dim> translate = motion.translate;
    Pose<Dim> pose{Matrix<Dim>::Identity(), elapsed * translate, Matrix<Dim>::Zero(),
                   is_moving ? translate : Vector<Dim>::Zero()};
    for (const Spin& spin : motion.rotate) {
        const double omega = kRadiansPerDegree * spin.degrees_per_s;
        const Matrix<Dim> turn = plane_rotation<Dim>(spin.plane, omega * elapsed);
        Matrix<Dim> generator = Matrix<Dim>::Zero();
        generator(spin.plane.to, spin.plane.from) = is_moving ? omega : 0;
        generator(spin.plane.from, spin.plane.to) = is_moving ? -omega : 0;
        pose.rate = (generator * turn * pose.rotation + turn * pose.rate).eval();
        pose.rotation = (turn * pose.rotation).eval();
    }
    return pose;
}

template Matrix<2> plane_rotation<2>(const Plane&, double);
template Matrix<3> plane_rotation<3>(const Plane&, double);
template Matrix<4> plane_rotation<4>(const Plane&, double);
template SimplexMesh<3> place<3>(SimplexMesh<3>, const Body&);
template SimplexMesh<4> place<4>(SimplexMesh<4>, const Body&);
template Pose<3> pose_at<3>(const Motion&, double);
template Pose<4> pose_at<4>(const Motion&, double);

}  // namespace pent::simulator
