#pragma once

#include <pent/simplex_mesh.h>
#include <pent/viewer/camera.h>

#include <Eigen/Geometry>

#include <map>

namespace pent::viewer {

/// Finds what the cameras of a run see: all of the bodies, and the balls and hollows of obstacles
/// that are no larger than the bodies reach.
class Framing {
public:
    /// @param tile   For tiles of a picture.
    /// @param sheet  For tiles of a contact sheet, or of a sweep.
    Framing(const CameraFit& tile, const CameraFit& sheet) : nothing_{tile, sheet, {}} {}

    /// Points of a body.
    void add(const Positions<3>& points);

    /// Points of something round, m.
    void add_round(const Positions<3>& points, double radius);

    /// Settles the cameras.
    void settle();

    [[nodiscard]] const Camera& tile_camera() const { return tile_camera_; }
    [[nodiscard]] const Camera& sheet_camera() const { return sheet_camera_; }

    /// How far the bodies reach: balls and hollows of a larger radius are not seen whole, m.
    [[nodiscard]] double reach() const { return reach_; }

    /// Around all that is seen; empty if there is no body in it.
    [[nodiscard]] const Eigen::AlignedBox3d& box() const { return all_.box; }

private:
    struct Extent {
        CameraFit tile_fit;
        CameraFit sheet_fit;
        Eigen::AlignedBox3d box;

        void add(const Positions<3>& points);
        void add(const Extent& other);
    };

    Extent nothing_;
    Extent all_ = nothing_;
    std::map<double, Extent> rounds_;  // of what is round, by its radius
    double reach_ = 0;
    Camera tile_camera_;
    Camera sheet_camera_;
};

}  // namespace pent::viewer
