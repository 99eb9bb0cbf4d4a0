#pragma once

#include <pent/obstacle.h>
#include <pent/viewer/hyperplane.h>
#include <pent/viewer/surface.h>

#include <Eigen/Core>

#include <optional>

namespace pent::viewer {

/// The points x with normal . x < offset.
struct Plane {
    Eigen::Vector3d normal;  ///< Unit length.
    double offset = 0;       ///< m.
};

struct Sphere {
    Eigen::Vector3d center;  ///< m.
    double radius = 0;       ///< m, > 0.
};

/// What a hyperplane meets of an obstacle: solid is what is below the plane, in the ball, out of
/// the hollow and in the block, of those that are there. Where none is, all of the slice is solid.
struct ObstacleSlice {
    bool is_empty = false;  ///< Nothing is solid; the others are not there then.
    std::optional<Plane> plane{};
    std::optional<Sphere> ball{};
    /// Reaches below the plane, if there is one.
    std::optional<Sphere> hollow{};
    /// A convex body with flat sides, as its surface.
    std::optional<TriangleMesh> block{};

    [[nodiscard]] bool is_everything() const {
        return !is_empty && !plane && !ball && !hollow && !block;
    }
};

/// The slice of an obstacle, in the 3D frame of the hyperplane as slices of bodies are.
///
/// A half-space parallel to the hyperplane (to 1e-12) gives everything or nothing. What only
/// touches the hyperplane gives nothing.
[[nodiscard]] ObstacleSlice slice(const ObstacleShape<4>& obstacle,
                                  const FramedHyperplane& hyperplane);

/// An obstacle in three dimensions, where no hyperplane is needed.
[[nodiscard]] ObstacleSlice whole(const ObstacleShape<3>& obstacle);

}  // namespace pent::viewer
