#include "pent/viewer/hyperplane.h"

#include <pent/error.h>
#include <pent/geometry.h>

#include <cmath>

namespace pent::viewer {

namespace {

// The rotation in the plane of unit n and e_w that takes n to e_w; n_w >= 0 keeps it well away from
// the pole n = -e_w of the formula.
Eigen::Matrix4d smallest_rotation_to_w(const Eigen::Vector4d& n) {
    const Eigen::Vector4d e = Eigen::Vector4d::UnitW();
    return Eigen::Matrix4d::Identity() - (e + n) * (e + n).transpose() / (1.0 + n.w())
           + 2.0 * e * n.transpose();
}

}  // namespace

Eigen::Matrix4d rotation_matrix(std::span<const PlaneRotation> rotations) {
    Eigen::Matrix4d total = Eigen::Matrix4d::Identity();
    for (const PlaneRotation& rotation : rotations) {
        total = plane_rotation<4>(rotation.from, rotation.to, rotation.radians) * total;
    }
    return total;
}

FramedHyperplane hyperplane_at(double offset, std::span<const PlaneRotation> rotations) {
    return {rotation_matrix(rotations), offset};
}

FramedHyperplane hyperplane_across(const Eigen::Vector4d& normal, double offset) {
    const double largest = normal.cwiseAbs().maxCoeff();
    if (!std::isfinite(largest) || largest == 0.0) {
        throw Error(
            "hyperplane: the normal is zero or not finite; give four numbers, not all zero");
    }
    const Eigen::Vector4d n = (normal / largest).normalized();
    if (n.w() >= 0) {
        return {smallest_rotation_to_w(n), offset};
    }
    const Eigen::Vector4d flip(1, 1, -1, -1);
    return {smallest_rotation_to_w(flip.cwiseProduct(n)) * flip.asDiagonal(), offset};
}

}  // namespace pent::viewer
