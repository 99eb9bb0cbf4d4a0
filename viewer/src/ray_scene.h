#pragma once

#include "ray_space.h"

#include <pent/viewer/render.h>

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <embree3/rtcore.h>
#include <limits>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace pent::viewer {

/// Handles of Embree, released at the end of their scope.
struct ReleaseDevice {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using DeviceHandle = std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice>;
using SceneHandle = std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene>;

/// What a ray meets first.
struct RayHit {
    float distance = std::numeric_limits<float>::infinity();  ///< Infinite if nothing.
    std::uint32_t object = 0;                                 ///< Index among the objects.
    std::uint32_t triangle = 0;
    float u = 0;  ///< Weights of the triangle's second and third corners.
    float v = 0;
    Vec normal = Vec::Zero();  ///< Of the triangle, unit, outward.

    [[nodiscard]] bool is_hit() const { return distance < std::numeric_limits<float>::infinity(); }
};

/// Objects ready to be met by rays, in the coordinates of a RaySpace.
class RayScene {
public:
    /// Keeps a view of the objects; takes those that are opaque, or those that are ghosts.
    RayScene(RTCDevice device,
             std::span<const RenderObject> objects,
             bool ghosts,
             const RaySpace& space);

    [[nodiscard]] bool is_empty() const { return is_empty_; }

    [[nodiscard]] RayHit first_hit(const Vec& from, const Vec& direction, float nearest) const;

    /// Rays from one point that are asked together, which is faster than one by one.
    struct Bundle {
        static constexpr int kRays = 8;
        Vec from = Vec::Zero();
        std::array<Vec, kRays> directions{};
        std::array<float, kRays> farthest{};  ///< Of each ray.
        int count = 0;                        ///< How many of them there are.

        void add(const Vec& direction, float max_distance) {
            directions[count] = direction;
            farthest[count] = max_distance;
            ++count;
        }
    };

    /// Whether each ray of a bundle meets anything: bit k for ray k.
    [[nodiscard]] unsigned blocked(const Bundle& bundle) const;

    /// Corner k of the triangle that was hit.
    [[nodiscard]] Vec corner(const RayHit& hit, int k) const;

    /// Smooth normal at the hit, unit.
    [[nodiscard]] Vec smooth_normal(const RayHit& hit) const;

    /// Normal of corner k of the triangle that was hit.
    [[nodiscard]] Vec corner_normal(const RayHit& hit, int k) const;

    [[nodiscard]] Color color(const RayHit& hit) const;

    [[nodiscard]] float opacity(const RayHit& hit) const { return objects_[hit.object].opacity; }

private:
    std::span<const RenderObject> objects_;
    std::vector<Eigen::Matrix4Xf> vertices_;  // padded: Embree reads 16 bytes a vertex
    SceneHandle scene_;
    bool is_empty_ = true;
};

}  // namespace pent::viewer
