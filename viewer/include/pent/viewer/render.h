#pragma once

#include <pent/simplex_mesh.h>
#include <pent/viewer/camera.h>
#include <pent/viewer/color.h>
#include <pent/viewer/image.h>
#include <pent/viewer/obstacle_slice.h>

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace pent::viewer {

/// A triangle surface as it is to be seen.
struct RenderObject {
    Positions<3> positions;   ///< 3 x vertices, m.
    Simplices<3> triangles;   ///< 3 x triangles, counter-clockwise from outside.
    Positions<3> normals;     ///< 3 x 3 triangles: unit, one per corner of each triangle.
    Eigen::Matrix3Xf colors;  ///< 3 x vertices, linear light: the share it reflects.
    float opacity = 1;        ///< Below 1 it is a ghost: thin glass that casts no shadow.
};

struct RenderOptions {
    int width = 1280;  ///< Pixels, at least 1.
    int height = 720;  ///< Pixels, at least 1.
    /// Height y of a floor that takes the shadows, m; none: no floor.
    std::optional<double> floor;
    /// Obstacles without end, or larger than what is looked at. They are seen where they face the
    /// eye, take shadows and throw none, and fade away around the scene. What is behind the rim of
    /// a hollow shows through it.
    std::vector<ObstacleSlice> grounds;
    /// Linear light: the share the grounds reflect.
    Color ground_color = Color::Constant(0.5F);
    /// Diagonal of what is looked at, m, over 0: how far things shade each other goes by it.
    double scene_size = 1;
    /// The middle of it.
    Eigen::Vector3d scene_center = Eigen::Vector3d::Zero();
};

/// A ray tracer: one soft key light, light from the sky with ambient occlusion, smooth edges.
///
/// The light stands to the left above the camera. The inside of a surface, which nobody should ever
/// see, is a glaring magenta.
class Renderer {
public:
    /// Throws an Error if the ray tracing library does not start.
    Renderer();
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;
    Renderer(Renderer&&) = delete;
    Renderer& operator=(Renderer&&) = delete;

    /// Pixels are independent of the number of threads.
    [[nodiscard]] Image render(std::span<const RenderObject> objects,
                               const Camera& camera,
                               const RenderOptions& options) const;

private:
    struct Device;
    std::unique_ptr<Device> device_;
};

}  // namespace pent::viewer
