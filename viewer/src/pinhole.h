#pragma once

#include "ray_space.h"

#include <pent/viewer/camera.h>
#include <pent/viewer/render.h>

#include <cmath>

namespace pent::viewer {

/// The rays of a camera through its picture.
class Pinhole {
public:
    Pinhole(const Camera& camera, const RaySpace& space, const RenderOptions& options)
        : eye_(space.point(camera.position)),
          frame_(camera_frame(camera).cast<float>()),
          slope_(static_cast<float>(std::tan(camera.field_of_view / 2))),
          width_(static_cast<float>(options.width)),
          height_(static_cast<float>(options.height)) {}

    [[nodiscard]] const Vec& eye() const { return eye_; }

    /// Unit, through a point of the picture, pixels from its upper left corner.
    [[nodiscard]] Vec direction(float x, float y) const {
        const float across = slope_ * (2 * x - width_) / height_;
        const float upward = slope_ * (height_ - 2 * y) / height_;
        return (frame_ * Vec(across, upward, -1)).normalized();
    }

    /// The size of a pixel at a distance.
    [[nodiscard]] float footprint(float distance) const { return 2 * slope_ * distance / height_; }

private:
    Vec eye_;
    Eigen::Matrix3f frame_;  // right, up, back
    float slope_;            // of the upper edge of the picture
    float width_;            // pixels
    float height_;           // pixels
};

}  // namespace pent::viewer
