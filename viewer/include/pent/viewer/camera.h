#pragma once

#include <pent/simplex_mesh.h>

#include <Eigen/Core>

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

/// Finds the nearest camera in a wanted direction that sees all of a number of points, which need
/// not be there at once.
class CameraFit {
public:
    /// @param aspect  Width over height.
    /// @param legend  Share of the picture left free at the bottom, if more than the margin;
    ///                0..0.5.
    CameraFit(double aspect, const ViewOptions& view, double legend = 0);

    /// @param points  3 x n, m.
    void add(const Positions<3>& points);

    /// The points of another one, of the same aspect, view and legend.
    void add(const CameraFit& other);

    /// The camera; for no point, or a single one, one that looks at it from a meter or so,
    /// from farther where coordinates are so large that a meter is nothing to them.
    [[nodiscard]] Camera camera() const;

private:
    Eigen::Matrix3d frame_;     // right, up, back
    double field_of_view_;      // radians
    Eigen::Vector4d slopes_;    // of the used part of the picture: right, left, top, bottom
    Eigen::Vector4d supports_;  // how far points reach across, in the same order
    Eigen::Vector2d depth_;     // lowest and highest coordinate along back
};

}  // namespace pent::viewer
