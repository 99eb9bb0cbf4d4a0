#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace pent::viewer {

/// A perspective camera that stands upright: the picture's y axis is up.
struct Camera {
    Eigen::Vector3d position = {0, 0, 5};
    Eigen::Vector3d target = {0, 0,
                              0};  ///< In the middle of the picture; not straight above or below.
    double field_of_view = 0.5;    ///< Vertical, radians, between 0 and pi.
};

/// Right, up and back as columns: a right-handed orthonormal frame.
[[nodiscard]] Eigen::Matrix3d camera_frame(const Camera& camera);

/// Where to look from.
struct ViewOptions {
    double azimuth = 30;        ///< Degrees about y: 0 looks along -z, 90 along -x.
    double elevation = 18;      ///< Degrees above the horizon, -89..89.
    double field_of_view = 28;  ///< Vertical, degrees, 1..150.
    double margin = 0.08;       ///< Share of the picture left free at the sides, 0..0.5.
};

/// The nearest camera in the wanted direction that sees the whole box.
///
/// @param box     Empty, or a point, counts as a unit cube about the origin.
/// @param aspect  Width over height.
[[nodiscard]] Camera fit_camera(const Eigen::AlignedBox3d& box,
                                double aspect,
                                const ViewOptions& view = {});

}  // namespace pent::viewer
