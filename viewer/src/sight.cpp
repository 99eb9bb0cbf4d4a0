#include "sight.h"

#include <algorithm>
#include <cmath>

namespace pent::viewer {

namespace {

const Color kInside(1.0F, 0.0F, 0.5F);

// Moves a point on a flat triangle towards the curved surface its normals stand for, so that coarse
// meshes have no jagged shadows where the light grazes. Source: [hanika2021].
Vec lift(const RayScene& scene, const RayHit& hit, const Vec& point) {
    const float weights[3] = {1 - hit.u - hit.v, hit.u, hit.v};
    Vec moved = point;
    for (int k = 0; k < 3; ++k) {
        const Vec normal = scene.corner_normal(hit, k);
        const float below = std::min(0.0F, (point - scene.corner(hit, k)).dot(normal));
        moved -= weights[k] * below * normal;
    }
    return moved;
}

}  // namespace

Sight::Sight(RTCDevice device,
             std::span<const RenderObject> objects,
             const Camera& camera,
             const RenderOptions& options)
    : options_(options),
      space_(ray_space(options)),
      pinhole_(camera, space_, options),
      solids_(device, objects, false, space_),
      ghosts_(device, objects, true, space_) {
    for (const ObstacleSlice& slice : options.grounds) {
        grounds_.emplace_back(slice, space_);
    }
}

Sample Sight::look(float x, float y) const {
    const Vec ray = pinhole_.direction(x, y);
    Sample sample;
    const RayHit hit = solids_.is_empty() ? RayHit() : solids_.first_hit(pinhole_.eye(), ray, 0);
    if (hit.is_hit()) {
        const bool is_inside = hit.normal.dot(ray) > 0;
        const float side = is_inside ? -1 : 1;
        sample.seen = Seen::Surface;
        sample.distance = hit.distance;
        sample.point = pinhole_.eye() + hit.distance * ray;
        sample.flat = side * hit.normal;
        sample.normal = side * solids_.smooth_normal(hit);
        sample.lifted = is_inside ? sample.point : lift(solids_, hit, sample.point);
        sample.albedo = is_inside ? kInside : solids_.color(hit);
    } else {
        look_at_floor(ray, sample);
    }
    look_at_grounds(ray, sample);
    if (!ghosts_.is_empty()) {
        sample.ghost = ghosts_.first_hit(pinhole_.eye(), ray, 0).distance;
    }
    return sample;
}

void Sight::look_at_floor(const Vec& ray, Sample& sample) const {
    if (!options_.floor || ray.y() >= 0) {
        return;
    }
    const Vec& eye = pinhole_.eye();
    const float height = space_.length(*options_.floor - options_.scene_center.y());
    const float distance = (height - eye.y()) / ray.y();
    const Vec point = eye + distance * ray;
    const float presence = presence_at(Eigen::Vector2f(point.x(), point.z()).norm());
    if (distance > 0 && presence > 0) {
        sample.seen = Seen::Floor;
        sample.distance = distance;
        sample.point = point;
        sample.lifted = point;
        sample.presence = presence;
    }
}

void Sight::look_at_grounds(const Vec& ray, Sample& sample) const {
    for (const Ground& ground : grounds_) {
        const GroundHit hit = ground.first_hit(pinhole_.eye(), ray);
        // What has a color of its own is not hidden by the floor, which is air but for shadows.
        const bool is_behind = hit.distance >= sample.distance && sample.seen != Seen::Floor;
        if (!hit.is_hit() || is_behind) {
            continue;
        }
        const Vec point = pinhole_.eye() + hit.distance * ray;
        const float presence = presence_at(ground.spread(point));
        if (presence == 0) {
            continue;
        }
        if (ground.has_hollow() && sample.seen == Seen::Surface) {
            sample.is_veiled = true;
            sample.veil = hit.normal;
            continue;
        }
        sample.seen = Seen::Ground;
        sample.distance = hit.distance;
        sample.point = point;
        sample.lifted = point;
        sample.normal = hit.normal;
        sample.flat = hit.normal;
        sample.albedo = options_.ground_color;
        sample.presence = presence;
        sample.is_veiled = false;
    }
}

// 1 near the scene, falling to 0 where nothing throws a shadow any more.
float Sight::presence_at(float spread) const {
    const float t = spread / (1.6F * scene_size());
    const float rest = std::clamp(2 - 2 * t, 0.0F, 1.0F);
    return rest * rest * (3 - 2 * rest);
}

bool Sight::is_alike(const Sample& a, const Sample& b) const {
    if (a.seen != b.seen || a.is_veiled != b.is_veiled || a.seen == Seen::Nothing) {
        return a.seen == b.seen && a.is_veiled == b.is_veiled;
    }
    const float off_plane = std::abs(a.normal.dot(b.point - a.point));
    return a.normal.dot(b.normal) > 0.9F && off_plane < 3 * pinhole_.footprint(a.distance);
}

}  // namespace pent::viewer
