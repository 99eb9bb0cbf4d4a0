#pragma once

#include "ground.h"
#include "pinhole.h"
#include "ray_scene.h"

#include <pent/viewer/color.h>
#include <pent/viewer/render.h>

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace pent::viewer {

enum class Seen : std::uint8_t { Nothing, Floor, Ground, Surface };

/// What is seen through one point of a picture.
struct Sample {
    Vec point = Vec::Zero();
    Vec normal = Vec::UnitY();  ///< Smooth, on the side that is seen.
    Vec flat = Vec::UnitY();    ///< Of the triangle, on that side.
    Vec lifted = Vec::Zero();   ///< Where its shadow rays start.
    Color albedo = Color::Zero();
    float distance = std::numeric_limits<float>::infinity();
    float ghost = std::numeric_limits<float>::infinity();  ///< Distance of the first ghost.
    float presence = 1;  ///< Of floor and ground, which fade away around the scene: 0..1.
    Seen seen = Seen::Nothing;
    bool is_veiled = false;   ///< Ground with a hollow is in front of the surface.
    Vec veil = Vec::UnitY();  ///< Its normal.
};

/// All that rays of a picture can meet, in the coordinates of its RaySpace.
class Sight {
public:
    /// Keeps views of the objects and of the options.
    Sight(RTCDevice device,
          std::span<const RenderObject> objects,
          const Camera& camera,
          const RenderOptions& options);

    [[nodiscard]] Sample look(float x, float y) const;

    /// Whether two samples see the same smooth piece of surface.
    [[nodiscard]] bool is_alike(const Sample& a, const Sample& b) const;

    /// Diagonal of what is looked at.
    [[nodiscard]] float scene_size() const { return space_.length(options_.scene_size); }
    [[nodiscard]] const Pinhole& pinhole() const { return pinhole_; }
    [[nodiscard]] const RayScene& solids() const { return solids_; }
    [[nodiscard]] const RayScene& ghosts() const { return ghosts_; }

private:
    void look_at_floor(const Vec& ray, Sample& sample) const;
    void look_at_grounds(const Vec& ray, Sample& sample) const;
    [[nodiscard]] float presence_at(float spread) const;

    const RenderOptions& options_;
    RaySpace space_;
    Pinhole pinhole_;
    RayScene solids_;
    RayScene ghosts_;
    std::vector<Ground> grounds_;
};

}  // namespace pent::viewer
