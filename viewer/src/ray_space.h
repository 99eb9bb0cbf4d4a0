#pragma once

#include <pent/viewer/render.h>

#include <Eigen/Core>

#include <cmath>

namespace pent::viewer {

using Vec = Eigen::Vector3f;

/// The coordinates that rays are traced in: single precision, about the middle of the scene and in
/// units of about its size, so that scenes far from zero lose nothing, and those of atoms and of
/// stars are well within the range of single precision.
struct RaySpace {
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< m.
    double unit = 1;  ///< m, a power of two: dividing by it rounds nothing.

    [[nodiscard]] Vec point(const Eigen::Vector3d& p) const {
        return ((p - origin) / unit).cast<float>();
    }
    [[nodiscard]] float length(double meters) const { return static_cast<float>(meters / unit); }
};

[[nodiscard]] inline RaySpace ray_space(const RenderOptions& options) {
    return {options.scene_center, std::ldexp(1.0, std::ilogb(options.scene_size))};
}

}  // namespace pent::viewer
