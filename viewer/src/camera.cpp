#include <pent/viewer/camera.h>

#include <algorithm>
#include <cmath>
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

Camera fit_camera(const Eigen::AlignedBox3d& box, double aspect, const ViewOptions& view) {
    const Eigen::AlignedBox3d seen =
        box.isEmpty()
            ? Eigen::AlignedBox3d(Eigen::Vector3d::Constant(-0.5), Eigen::Vector3d::Constant(0.5))
            : box;
    const double azimuth = radians(view.azimuth);
    const double elevation = radians(view.elevation);
    const Eigen::Vector3d back(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                               std::cos(azimuth) * std::cos(elevation));
    Camera camera;
    camera.field_of_view = radians(view.field_of_view);
    camera.target = seen.center();
    camera.position = camera.target + back;
    const Eigen::Matrix3d frame = camera_frame(camera);
    const double up_slope = std::tan(camera.field_of_view / 2) * (1.0 - 2.0 * view.margin);
    const double right_slope = up_slope * aspect;
    // A corner at q is in the picture if |q right| <= (distance - q back) slope, and so upwards.
    double distance = 1e-6;
    for (int i = 0; i < 8; ++i) {
        const Eigen::Vector3d corner =
            seen.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)) - camera.target;
        const Eigen::Vector3d q = frame.transpose() * corner;
        distance = std::max(
            {distance, q.z() + std::abs(q.x()) / right_slope, q.z() + std::abs(q.y()) / up_slope});
    }
    camera.position = camera.target + distance * back;
    return camera;
}

}  // namespace pent::viewer
