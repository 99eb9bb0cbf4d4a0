#include "pent/viewer/camera.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pent::viewer {

namespace {

double radians(double degrees) {
    return degrees * std::numbers::pi / 180.0;
}

}  // namespace

Eigen::Matrix3d camera_frame(const Camera& camera) {
    const Eigen::Vector3d back = (camera.position - camera.target).normalized();
    const Eigen::Vector3d right = Eigen::Vector3d::UnitY().cross(back).normalized();
    Eigen::Matrix3d frame;
    frame << right, back.cross(right), back;
    return frame;
}

// A point p, in the frame of the camera, is left of the right edge of the picture of an eye e if
//     (p - e).x + slope (p - e).z <= 0,
// and so for the other edges. So all that is needed of the points is the highest value of
// p.x + slope p.z, and the three like it.
CameraFit::CameraFit(double aspect, const ViewOptions& view, double legend)
    : field_of_view_(radians(view.field_of_view)),
      supports_(Eigen::Vector4d::Constant(-std::numeric_limits<double>::infinity())),
      depth_(std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()) {
    const double azimuth = radians(view.azimuth);
    const double elevation = radians(view.elevation);
    Camera camera;
    camera.target.setZero();
    camera.position << std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
        std::cos(azimuth) * std::cos(elevation);
    frame_ = camera_frame(camera);
    const double edge = std::tan(field_of_view_ / 2);
    const double upward = edge * (1.0 - 2.0 * view.margin);
    const double downward = edge * (1.0 - 2.0 * std::max(view.margin, legend));
    slopes_ << upward * aspect, upward * aspect, upward, downward;
}

void CameraFit::add(const Positions<3>& points) {
    for (const auto& point : points.colwise()) {
        const Eigen::Vector3d p = frame_.transpose() * point;
        const Eigen::Vector4d across(p.x(), -p.x(), p.y(), -p.y());
        supports_ = supports_.cwiseMax(across + slopes_ * p.z());
        depth_ << std::min(depth_[0], p.z()), std::max(depth_[1], p.z());
    }
}

void CameraFit::add(const CameraFit& other) {
    supports_ = supports_.cwiseMax(other.supports_);
    depth_ << std::min(depth_[0], other.depth_[0]), std::max(depth_[1], other.depth_[1]);
}

Camera CameraFit::camera() const {
    Camera camera;
    camera.field_of_view = field_of_view_;
    if (!(depth_[0] <= depth_[1])) {
        camera.target.setZero();
        camera.position = 3.0 * frame_.col(2);
        return camera;
    }
    // The nearest eye z at which there is room between the edges on both sides, and in that room
    // the middle:  s0 - slope0 z <= x <= slope1 z - s1,  and so for y.
    const Eigen::Vector4d& s = supports_;
    Eigen::Vector3d eye;
    eye.z() = std::max((s[0] + s[1]) / (slopes_[0] + slopes_[1]),
                       (s[2] + s[3]) / (slopes_[2] + slopes_[3]));
    eye.x() = (s[0] - s[1] + (slopes_[1] - slopes_[0]) * eye.z()) / 2;
    eye.y() = (s[2] - s[3] + (slopes_[3] - slopes_[2]) * eye.z()) / 2;
    const double middle = (depth_[0] + depth_[1]) / 2;
    // The points are one if nothing but the rounding of their coordinates is between them.
    const double farthest = std::max(eye.cwiseAbs().maxCoeff(), std::abs(middle));
    if (eye.z() - middle <= 64 * std::numeric_limits<double>::epsilon() * farthest) {
        eye.z() = middle + std::max(1.0, 1e-6 * farthest);
    }
    camera.position = frame_ * eye;
    camera.target = frame_ * Eigen::Vector3d(eye.x(), eye.y(), middle);
    return camera;
}

}  // namespace pent::viewer
