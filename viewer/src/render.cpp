#include "pent/viewer/render.h"

#include "lighting.h"
#include "ray_scene.h"

#include <pent/error.h>
#include <pent/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace pent::viewer {

namespace {

const Color kInside(1.0F, 0.0F, 0.5F);
const Color kBackgroundTop(0.66F, 0.70F, 0.75F);
const Color kBackgroundBottom(0.86F, 0.86F, 0.85F);
constexpr int kEdgeSamples = 8;
constexpr int kMaxGhostLayers = 24;

enum class Seen : std::uint8_t { Nothing, Floor, Surface };

// What is seen through one point of the picture.
struct Sample {
    Vec point = Vec::Zero();
    Vec normal = Vec::UnitY();  // smooth, on the side that is seen
    Vec flat = Vec::UnitY();    // of the triangle, on that side
    Vec lifted = Vec::Zero();   // where its shadow rays start
    Color albedo = Color::Zero();
    float distance = std::numeric_limits<float>::infinity();
    float ghost = std::numeric_limits<float>::infinity();  // distance of the first ghost
    Seen seen = Seen::Nothing;
};

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

// Renders in passes over the whole picture: what each pixel sees; how much light arrives there, by
// a few rays in a pattern that differs in each of 8 x 8 pixels; the mean of that over each such
// block, without crossing edges, which makes 64 times the rays of it; colors, with more samples at
// edges.
class Painter {
public:
    Painter(RTCDevice device,
            std::span<const RenderObject> objects,
            const Camera& camera,
            const RenderOptions& options)
        : options_(options),
          wide_(static_cast<float>(options.width)),
          high_(static_cast<float>(options.height)),
          origin_(options.scene_center),
          solid_(device, objects, false, origin_),
          ghosts_(device, objects, true, origin_),
          frame_(camera_frame(camera).cast<float>()),
          eye_((camera.position - origin_).cast<float>()),
          slope_(static_cast<float>(std::tan(camera.field_of_view / 2))),
          lighting_(make_lighting(camera_frame(camera), options.scene_size)),
          samples_(static_cast<std::size_t>(options.width) * options.height),
          rough_(samples_.size()),
          smooth_(samples_.size()) {}

    Image paint() {
        for_each_pixel([&](int x, int y) { samples_[index(x, y)] = look(middle(x), middle(y)); });
        for_each_pixel([&](int x, int y) {
            const Sample& sample = samples_[index(x, y)];
            if (sample.seen != Seen::Nothing) {
                rough_[index(x, y)] = trace(sample, pattern(x, y));
            }
        });
        for_each_pixel([&](int x, int y) {
            smooth_[index(x, y)] = filtered(rough_, x, y, 1, {1, 2, 2, 2, 1});
        });
        for_each_pixel([&](int x, int y) {
            rough_[index(x, y)] = filtered(smooth_, x, y, 4, {0, 1, 2, 1, 0});
        });
        std::swap(rough_, smooth_);
        Image image(options_.width, options_.height);
        for_each_pixel([&](int x, int y) {
            const Color color =
                is_at_edge(x, y)
                    ? antialiased(x, y)
                    : color_of(samples_[index(x, y)], smooth_[index(x, y)], middle(x), middle(y));
            const std::array<std::uint8_t, 3> bytes = to_srgb(color);
            std::copy(bytes.begin(), bytes.end(), image.pixel(x, y));
        });
        return image;
    }

private:
    template <typename Action>
    void for_each_pixel(const Action& action) const {
        constexpr int kRows = 4;
        parallel_for(options_.height, kRows, [&](int y) {
            for (int x = 0; x < options_.width; ++x) {
                action(x, y);
            }
        });
    }

    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(options_.width) * y + x;
    }

    [[nodiscard]] static float middle(int i) { return static_cast<float>(i) + 0.5F; }

    // Neighbors get patterns far apart: the bits of x and y, interleaved from the lowest on.
    [[nodiscard]] static int pattern(int x, int y) {
        int number = 0;
        for (int bit = 0; bit < 3; ++bit) {
            number = 4 * number + 2 * ((x ^ y) >> bit & 1) + (y >> bit & 1);
        }
        return number;
    }

    [[nodiscard]] Vec direction(float x, float y) const {
        const float across = slope_ * (2 * x - wide_) / high_;
        const float upward = slope_ * (high_ - 2 * y) / high_;
        return (frame_ * Vec(across, upward, -1)).normalized();
    }

    // The size of a pixel at a distance, m.
    [[nodiscard]] float footprint(float distance) const { return 2 * slope_ * distance / high_; }

    [[nodiscard]] Sample look(float x, float y) const {
        const Vec ray = direction(x, y);
        Sample sample;
        const RayHit hit = solid_.is_empty() ? RayHit() : solid_.first_hit(eye_, ray, 0);
        if (hit.is_hit()) {
            const bool is_inside = hit.normal.dot(ray) > 0;
            const float side = is_inside ? -1 : 1;
            sample.seen = Seen::Surface;
            sample.distance = hit.distance;
            sample.point = eye_ + hit.distance * ray;
            sample.flat = side * hit.normal;
            sample.normal = side * solid_.smooth_normal(hit);
            sample.lifted = is_inside ? sample.point : lift(solid_, hit, sample.point);
            sample.albedo = is_inside ? kInside : solid_.color(hit);
        } else {
            look_at_floor(ray, sample);
        }
        if (!ghosts_.is_empty()) {
            sample.ghost = ghosts_.first_hit(eye_, ray, 0).distance;
        }
        return sample;
    }

    void look_at_floor(const Vec& ray, Sample& sample) const {
        if (!options_.floor || ray.y() >= 0) {
            return;
        }
        const float height = static_cast<float>(*options_.floor - origin_.y());
        const float distance = (height - eye_.y()) / ray.y();
        const Vec point = eye_ + distance * ray;
        if (distance > 0 && floor_fade(point) > 0) {
            sample.seen = Seen::Floor;
            sample.distance = distance;
            sample.point = point;
            sample.lifted = point;
        }
    }

    // 1 near the scene, falling to 0 where nothing throws a shadow any more.
    [[nodiscard]] float floor_fade(const Vec& point) const {
        const float radius = Eigen::Vector2f(point.x(), point.z()).norm();
        const float t = radius / (1.6F * static_cast<float>(options_.scene_size));
        const float rest = std::clamp(2 - 2 * t, 0.0F, 1.0F);
        return rest * rest * (3 - 2 * rest);
    }

    [[nodiscard]] Visibility trace(const Sample& sample, int pattern) const {
        return solid_.is_empty()
                   ? Visibility()
                   : trace_visibility(solid_, lighting_, sample.lifted, sample.flat, pattern);
    }

    // Whether two pixels see the same smooth piece of surface.
    [[nodiscard]] bool is_alike(const Sample& a, const Sample& b) const {
        if (a.seen != b.seen || a.seen == Seen::Nothing) {
            return a.seen == b.seen;
        }
        const float off_plane = std::abs(a.normal.dot(b.point - a.point));
        return a.normal.dot(b.normal) > 0.9F && off_plane < 3 * footprint(a.distance);
    }

    // A weighted mean over 5 x 5 pixels `stride` apart, of those like the middle one. With weights
    // 1 2 2 2 1 at stride 1 each of 4 x 4 neighbors counts alike, and with 0 1 2 1 0 at stride 4
    // after that each of 8 x 8.
    [[nodiscard]] Visibility filtered(const std::vector<Visibility>& from,
                                      int x,
                                      int y,
                                      int stride,
                                      const std::array<float, 5>& weights) const {
        const Sample& here = samples_[index(x, y)];
        if (here.seen == Seen::Nothing) {
            return {};
        }
        Visibility sum{0, 0};
        float total = 0;
        for (int row = 0; row < 5; ++row) {
            const int j = y + stride * (row - 2);
            for (int column = 0; column < 5; ++column) {
                const int i = x + stride * (column - 2);
                const float weight = weights[row] * weights[column];
                if (weight > 0 && is_in_picture(i, j) && is_alike(here, samples_[index(i, j)])) {
                    sum.sky += weight * from[index(i, j)].sky;
                    sum.key += weight * from[index(i, j)].key;
                    total += weight;
                }
            }
        }
        return {sum.sky / total, sum.key / total};
    }

    [[nodiscard]] bool is_in_picture(int x, int y) const {
        return x >= 0 && y >= 0 && x < options_.width && y < options_.height;
    }

    [[nodiscard]] bool is_at_edge(int x, int y) const {
        const Sample& here = samples_[index(x, y)];
        const auto differs = [&](int i, int j) {
            if (!is_in_picture(i, j)) {
                return false;
            }
            const Sample& there = samples_[index(i, j)];
            const bool ghost_differs =
                here.ghost != there.ghost
                && !(std::abs(here.ghost - there.ghost) < 12 * footprint(here.ghost));
            return ghost_differs || !is_alike(here, there);
        };
        return differs(x - 1, y) || differs(x + 1, y) || differs(x, y - 1) || differs(x, y + 1);
    }

    // The light at a sample inside a pixel: that of the neighboring pixel most like it.
    [[nodiscard]] Visibility borrowed(const Sample& sample, int x, int y) const {
        const Visibility* best = nullptr;
        float best_distance = std::numeric_limits<float>::infinity();
        for (int j = std::max(0, y - 1); j <= std::min(options_.height - 1, y + 1); ++j) {
            for (int i = std::max(0, x - 1); i <= std::min(options_.width - 1, x + 1); ++i) {
                const Sample& there = samples_[index(i, j)];
                const float distance = (there.point - sample.point).squaredNorm();
                if (distance < best_distance && is_alike(sample, there)) {
                    best_distance = distance;
                    best = &smooth_[index(i, j)];
                }
            }
        }
        return best != nullptr ? *best : trace(sample, pattern(x, y));
    }

    [[nodiscard]] Color antialiased(int x, int y) const {
        Color sum = Color::Zero();
        for (int k = 0; k < kEdgeSamples; ++k) {
            constexpr int kRows[kEdgeSamples] = {3, 6, 1, 4, 7, 2, 5, 0};
            const float sx = static_cast<float>(x) + middle(k) / kEdgeSamples;
            const float sy = static_cast<float>(y) + middle(kRows[k]) / kEdgeSamples;
            const Sample sample = look(sx, sy);
            const Visibility light =
                sample.seen == Seen::Nothing ? Visibility() : borrowed(sample, x, y);
            // Clamped first, so that a glint cannot outshine the other samples of its pixel.
            sum += color_of(sample, light, sx, sy).cwiseMin(1.0F);
        }
        return sum / kEdgeSamples;
    }

    [[nodiscard]] Color background(float y) const {
        const float t = y / high_;
        return kBackgroundTop + t * (kBackgroundBottom - kBackgroundTop);
    }

    [[nodiscard]] Color color_of(const Sample& sample,
                                 const Visibility& light,
                                 float x,
                                 float y) const {
        Color color = background(y);
        if (sample.seen == Seen::Floor) {
            const float shade = 1 - floor_light(lighting_, light);
            color *= 1 - floor_fade(sample.point) * shade;
        } else if (sample.seen == Seen::Surface) {
            const Vec to_eye = (eye_ - sample.point).normalized();
            color = shade(lighting_, sample.albedo, sample.normal, to_eye, light);
        }
        return sample.ghost < sample.distance ? behind_ghosts(color, sample, direction(x, y))
                                              : color;
    }

    // Lays the ghosts in front of a sample over its color: thin glass, denser where it is seen at a
    // slant.
    [[nodiscard]] Color behind_ghosts(const Color& behind,
                                      const Sample& sample,
                                      const Vec& ray) const {
        Color color = Color::Zero();
        float through = 1;
        float nearest = 0;
        for (int layer = 0; layer < kMaxGhostLayers && through > 0.02F; ++layer) {
            const RayHit hit = ghosts_.first_hit(eye_, ray, nearest);
            if (!(hit.distance < sample.distance)) {
                break;
            }
            const Vec smooth = ghosts_.smooth_normal(hit);
            const float facing = std::abs(smooth.dot(ray));
            const float slant = (1 - facing) * (1 - facing);
            const float opacity = ghosts_.opacity(hit);
            const float cover = opacity + (1 - opacity) * 0.6F * slant * slant;
            const Vec normal = smooth.dot(ray) > 0 ? Vec(-smooth) : smooth;
            const Color tint = shade(lighting_, ghosts_.color(hit), normal, -ray, {1, 0.6F});
            color += through * cover * tint;
            through *= 1 - cover;
            nearest = hit.distance * (1 + 1e-5F) + 0.1F * lighting_.skin;
        }
        return color + through * behind;
    }

    const RenderOptions& options_;
    float wide_;
    float high_;
    Eigen::Vector3d origin_;
    RayScene solid_;
    RayScene ghosts_;
    Eigen::Matrix3f frame_;
    Vec eye_;
    float slope_;
    Lighting lighting_;
    std::vector<Sample> samples_;
    std::vector<Visibility> rough_;
    std::vector<Visibility> smooth_;
};

}  // namespace

struct Renderer::Device {
    DeviceHandle handle;
};

Renderer::Renderer()
    : device_(std::make_unique<Device>(Device{DeviceHandle(rtcNewDevice(nullptr))})) {
    if (!device_->handle) {
        // GCOVR_EXCL_START: an old processor
        throw Error("pictures: the ray tracer Embree does not start on this machine");
        // GCOVR_EXCL_STOP
    }
}

Renderer::~Renderer() = default;

Image Renderer::render(std::span<const RenderObject> objects,
                       const Camera& camera,
                       const RenderOptions& options) const {
    return Painter(device_->handle.get(), objects, camera, options).paint();
}

}  // namespace pent::viewer
