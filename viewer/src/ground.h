#pragma once

#include "ray_space.h"

#include <pent/viewer/obstacle_slice.h>

#include <Eigen/Core>

#include <limits>

namespace pent::viewer {

/// Where a ray meets ground.
struct GroundHit {
    float distance = std::numeric_limits<float>::infinity();  ///< Infinite if nowhere.
    Vec normal = Vec::UnitY();                                ///< Unit, out of the solid.

    [[nodiscard]] bool is_hit() const { return distance < std::numeric_limits<float>::infinity(); }
};

/// The slice of an obstacle as rays meet it, in closed form: seen alone where it faces the eye, so
/// that one looks into hollows and through walls from behind.
class Ground {
public:
    Ground(const ObstacleSlice& slice, const RaySpace& space);

    [[nodiscard]] GroundHit first_hit(const Vec& from, const Vec& direction) const;

    /// Whether something may be in it, which its rim then hides.
    [[nodiscard]] bool has_hollow() const { return slice_.hollow.has_value(); }

    /// How far a point of it is from where it is nearest to the origin: along a plane, exactly.
    [[nodiscard]] float spread(const Vec& point) const;

private:
    ObstacleSlice slice_;  // in the coordinates of rays
    double nearest_ = 0;   // distance to the origin
};

}  // namespace pent::viewer
