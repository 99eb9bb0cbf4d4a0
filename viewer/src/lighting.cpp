#include "lighting.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace pent::viewer {

namespace {

constexpr float kKeyRadius = 0.14F;  // of the key light seen from the scene, radians
constexpr float kKeyPower = 0.85F;
constexpr float kFillPower = 0.10F;
constexpr float kGloss = 0.05F;
constexpr float kShininess = 30.0F;
const Color kSky(0.36F, 0.38F, 0.42F);
const Color kBounce(0.24F, 0.22F, 0.20F);

// Point i of the R2 sequence in the unit square: any run of it is spread evenly.
// Source: [roberts2018].
Eigen::Vector2f even_point(int i) {
    const double g = 1.32471795724474602596;  // root of x^3 = x + 1
    const double x = 0.5 + (i + 1) / g;
    const double y = 0.5 + (i + 1) / (g * g);
    return {static_cast<float>(x - std::floor(x)), static_cast<float>(y - std::floor(y))};
}

// Uniform on the unit disk, by areas of equal measure.
Eigen::Vector2f disk_point(const Eigen::Vector2f& square) {
    const float radius = std::sqrt(square.x());
    const float angle = 2 * std::numbers::pi_v<float> * square.y();
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

template <int Rays>
using DiskPoints = std::array<Eigen::Vector2f, static_cast<std::size_t>(Rays) * kPatterns>;

// The sequence is dealt out to the patterns in turn: where ray k of a pattern is.
std::size_t ray_index(int pattern, int k) {
    return static_cast<std::size_t>(pattern) + static_cast<std::size_t>(kPatterns) * k;
}

template <int Rays>
DiskPoints<Rays> make_disk_points() {
    DiskPoints<Rays> points;
    for (std::size_t i = 0; i < points.size(); ++i) {
        points[i] = disk_point(even_point(static_cast<int>(i)));
    }
    return points;
}

// Two unit vectors across a unit vector. Source: [duff2017].
struct Across {
    Vec a;
    Vec b;
};

Across across(const Vec& n) {
    const float sign = std::copysign(1.0F, n.z());
    const float p = -1.0F / (sign + n.z());
    const float q = n.x() * n.y() * p;
    return {Vec(1 + sign * n.x() * n.x() * p, sign * q, -sign * n.x()),
            Vec(q, sign + n.y() * n.y() * p, -n.y())};
}

}  // namespace

Lighting make_lighting(const Eigen::Matrix3d& camera_frame, float scene_size) {
    const Vec right = camera_frame.col(0).cast<float>();
    const Vec toward_eye = Vec(camera_frame.col(2).cast<float>().cwiseProduct(Vec(1, 0, 1)));
    const Vec back = toward_eye.squaredNorm() > 1e-12F ? Vec(toward_eye.normalized())
                                                       : Vec(camera_frame.col(1).cast<float>());
    Lighting lighting;
    lighting.to_key = (-0.65F * right + 1.0F * lighting.up + 0.55F * back).normalized();
    lighting.to_fill = (0.8F * right + 0.1F * lighting.up + 0.6F * back).normalized();
    lighting.occlusion_distance = 0.2F * scene_size;
    lighting.skin = 1e-4F * scene_size;
    return lighting;
}

Visibility trace_visibility(const RayScene& scene,
                            const Lighting& lighting,
                            const Vec& point,
                            const Vec& normal,
                            int pattern) {
    static const DiskPoints<kSkyRays> sky_points = make_disk_points<kSkyRays>();
    static const DiskPoints<kKeyRays> key_points = make_disk_points<kKeyRays>();
    static_assert(kSkyRays + kKeyRays <= RayScene::Bundle::kRays);
    RayScene::Bundle bundle;
    bundle.from = point + lighting.skin * normal;
    const Across tangent = across(normal);
    for (int k = 0; k < kSkyRays; ++k) {
        const Eigen::Vector2f& d = sky_points[ray_index(pattern, k)];
        const float height = std::sqrt(std::max(0.0F, 1 - d.squaredNorm()));
        bundle.add(d.x() * tangent.a + d.y() * tangent.b + height * normal,
                   lighting.occlusion_distance);
    }
    const Across lamp = across(lighting.to_key);
    for (int k = 0; k < kKeyRays; ++k) {
        const Eigen::Vector2f d = kKeyRadius * key_points[ray_index(pattern, k)];
        const Vec direction = (lighting.to_key + d.x() * lamp.a + d.y() * lamp.b).normalized();
        if (normal.dot(direction) > 0) {
            bundle.add(direction, std::numeric_limits<float>::infinity());
        }
    }
    const unsigned open = ~scene.blocked(bundle) & ((1U << bundle.count) - 1);
    constexpr unsigned kSkyMask = (1U << kSkyRays) - 1;
    return {static_cast<float>(std::popcount(open & kSkyMask)) / kSkyRays,
            static_cast<float>(std::popcount(open & ~kSkyMask)) / kKeyRays};
}

Color shade(const Lighting& lighting,
            const Color& albedo,
            const Vec& normal,
            const Vec& to_eye,
            const Visibility& visibility) {
    const float upward = 0.5F + 0.5F * normal.dot(lighting.up);
    const Color ambient = visibility.sky * (kBounce + upward * (kSky - kBounce));
    const float key = kKeyPower * visibility.key * std::max(0.0F, normal.dot(lighting.to_key));
    const float fill = kFillPower * visibility.sky * std::max(0.0F, normal.dot(lighting.to_fill));
    const Vec halfway = (to_eye + lighting.to_key).normalized();
    const float gloss =
        kGloss * visibility.key * std::pow(std::max(0.0F, normal.dot(halfway)), kShininess);
    return albedo.cwiseProduct(ambient + Color::Constant(key + fill)) + Color::Constant(gloss);
}

float floor_light(const Lighting& lighting, const Visibility& visibility) {
    const float key = kKeyPower * lighting.to_key.dot(lighting.up);
    const float sky = kSky.y();
    return (sky * visibility.sky + key * visibility.key) / (sky + key);
}

}  // namespace pent::viewer
