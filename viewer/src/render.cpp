#include "pent/viewer/render.h"

#include "light_map.h"
#include "lighting.h"
#include "pixels.h"
#include "sight.h"

#include <pent/error.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pent::viewer {

namespace {

const Color kBackgroundTop(0.66F, 0.70F, 0.75F);
const Color kBackgroundBottom(0.86F, 0.86F, 0.85F);
constexpr int kEdgeSamples = 8;
constexpr int kMaxGhostLayers = 24;
constexpr float kVeil = 0.4F;            // share of the ground's rim before what it hides
constexpr Visibility kOpen = {1, 0.6F};  // the light on what is not looked into: ghosts, veils

float middle(int i) {
    return static_cast<float>(i) + 0.5F;
}

// Renders in passes over the whole picture: what each pixel sees; how much light arrives there;
// colors, with more samples at edges.
class RayCaster {
public:
    RayCaster(RTCDevice device,
              std::span<const RenderObject> objects,
              const Camera& camera,
              const RenderOptions& options)
        : width_(options.width),
          height_(options.height),
          ground_color_(options.ground_color),
          sight_(device, objects, camera, options),
          lighting_(make_lighting(camera_frame(camera), sight_.scene_size())),
          samples_(look_everywhere()),
          light_(sight_, lighting_, samples_) {}

    [[nodiscard]] Image picture() const {
        Image image(width_, height_);
        for_each_pixel(width_, height_, [&](int x, int y) {
            const Color color = is_at_edge(x, y) ? antialiased(x, y)
                                                 : color_of(samples_.at(x, y), light_.at(x, y),
                                                            middle(x), middle(y));
            const std::array<std::uint8_t, 3> bytes = to_srgb(color);
            std::copy(bytes.begin(), bytes.end(), image.pixel(x, y));
        });
        return image;
    }

private:
    [[nodiscard]] PixelGrid<Sample> look_everywhere() const {
        PixelGrid<Sample> samples(width_, height_);
        for_each_pixel(width_, height_,
                       [&](int x, int y) { samples.at(x, y) = sight_.look(middle(x), middle(y)); });
        return samples;
    }

    [[nodiscard]] bool is_at_edge(int x, int y) const {
        const Sample& here = samples_.at(x, y);
        const auto differs = [&](int i, int j) {
            if (!samples_.has(i, j)) {
                return false;
            }
            const Sample& there = samples_.at(i, j);
            const float near = 12 * sight_.pinhole().footprint(here.ghost);
            const bool ghost_differs =
                here.ghost != there.ghost && !(std::abs(here.ghost - there.ghost) < near);
            return ghost_differs || !sight_.is_alike(here, there);
        };
        return differs(x - 1, y) || differs(x + 1, y) || differs(x, y - 1) || differs(x, y + 1);
    }

    [[nodiscard]] Color antialiased(int x, int y) const {
        Color sum = Color::Zero();
        for (int k = 0; k < kEdgeSamples; ++k) {
            constexpr int kRows[kEdgeSamples] = {3, 6, 1, 4, 7, 2, 5, 0};
            const float sx = static_cast<float>(x) + middle(k) / kEdgeSamples;
            const float sy = static_cast<float>(y) + middle(kRows[k]) / kEdgeSamples;
            const Sample sample = sight_.look(sx, sy);
            const Visibility light =
                sample.seen == Seen::Nothing ? Visibility() : light_.borrowed(sample, x, y);
            // Clamped first, so that a glint cannot outshine the other samples of its pixel.
            sum += color_of(sample, light, sx, sy).cwiseMin(1.0F);
        }
        return sum / kEdgeSamples;
    }

    [[nodiscard]] Color background(float y) const {
        const float t = y / static_cast<float>(height_);
        return kBackgroundTop + t * (kBackgroundBottom - kBackgroundTop);
    }

    [[nodiscard]] Color color_of(const Sample& sample,
                                 const Visibility& light,
                                 float x,
                                 float y) const {
        const Vec ray = sight_.pinhole().direction(x, y);
        Color color = background(y);
        if (sample.seen == Seen::Floor) {
            color *= 1 - sample.presence * (1 - floor_light(lighting_, light));
        } else if (sample.seen != Seen::Nothing) {
            const Color lit = shade(lighting_, sample.albedo, sample.normal, -ray, light);
            color += sample.presence * (lit - color);
        }
        if (sample.is_veiled) {
            color += kVeil * (shade(lighting_, ground_color_, sample.veil, -ray, kOpen) - color);
        }
        return sample.ghost < sample.distance ? behind_ghosts(color, sample, ray) : color;
    }

    // Lays the ghosts in front of a sample over its color: thin glass, denser where it is seen at a
    // slant.
    [[nodiscard]] Color behind_ghosts(const Color& behind,
                                      const Sample& sample,
                                      const Vec& ray) const {
        const RayScene& ghosts = sight_.ghosts();
        Color color = Color::Zero();
        float through = 1;
        float nearest = 0;
        for (int layer = 0; layer < kMaxGhostLayers && through > 0.02F; ++layer) {
            const RayHit hit = ghosts.first_hit(sight_.pinhole().eye(), ray, nearest);
            if (!(hit.distance < sample.distance)) {
                break;
            }
            const Vec smooth = ghosts.smooth_normal(hit);
            const float facing = std::abs(smooth.dot(ray));
            const float slant = (1 - facing) * (1 - facing);
            const float opacity = ghosts.opacity(hit);
            const float cover = opacity + (1 - opacity) * 0.6F * slant * slant;
            const Vec normal = smooth.dot(ray) > 0 ? Vec(-smooth) : smooth;
            color += through * cover * shade(lighting_, ghosts.color(hit), normal, -ray, kOpen);
            through *= 1 - cover;
            nearest = hit.distance * (1 + 1e-5F) + 0.1F * lighting_.skin;
        }
        return color + through * behind;
    }

    int width_;
    int height_;
    Color ground_color_;
    Sight sight_;
    Lighting lighting_;
    PixelGrid<Sample> samples_;
    LightMap light_;
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
    return RayCaster(device_->handle.get(), objects, camera, options).picture();
}

}  // namespace pent::viewer
