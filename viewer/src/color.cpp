#include "pent/viewer/color.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pent::viewer {

namespace {

// Stops in Oklch: lightness, chroma, hue in degrees.
struct Stop {
    float lightness;
    float chroma;
    float hue;
};

constexpr std::array<Stop, 5> kHeat = {{{0.60F, 0.11F, 255},
                                        {0.78F, 0.09F, 195},
                                        {0.89F, 0.14F, 105},
                                        {0.74F, 0.16F, 60},
                                        {0.55F, 0.20F, 25}}};

constexpr std::array<Stop, 5> kDiverging = {{{0.52F, 0.10F, 215},
                                             {0.73F, 0.09F, 205},
                                             {0.93F, 0.02F, 90},
                                             {0.76F, 0.13F, 60},
                                             {0.58F, 0.17F, 40}}};

constexpr std::array<Stop, 8> kBodies = {{{0.72F, 0.14F, 48},
                                          {0.68F, 0.11F, 240},
                                          {0.74F, 0.12F, 150},
                                          {0.72F, 0.13F, 350},
                                          {0.82F, 0.13F, 92},
                                          {0.75F, 0.10F, 195},
                                          {0.68F, 0.12F, 300},
                                          {0.62F, 0.16F, 25}}};

Color color_of(const Stop& stop) {
    return from_oklch(stop.lightness, stop.chroma, stop.hue);
}

std::uint8_t to_srgb(float linear) {
    const float clamped = std::clamp(linear, 0.0F, 1.0F);
    const float encoded =
        clamped <= 0.0031308F ? 12.92F * clamped : 1.055F * std::pow(clamped, 1.0F / 2.4F) - 0.055F;
    return static_cast<std::uint8_t>(std::lround(255.0F * encoded));
}

float from_srgb(float encoded) {
    return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

// Mixes in Oklab, so that the way from one stop to the next looks even.
Color mix(const Stop& a, const Stop& b, float t) {
    const auto along = [&](const Stop& stop, auto trig) {
        return stop.chroma * trig(stop.hue * std::numbers::pi_v<float> / 180.0F);
    };
    const auto cosine = [](float angle) { return std::cos(angle); };
    const auto sine = [](float angle) { return std::sin(angle); };
    const float x = std::lerp(along(a, cosine), along(b, cosine), t);
    const float y = std::lerp(along(a, sine), along(b, sine), t);
    return from_oklch(std::lerp(a.lightness, b.lightness, t), std::hypot(x, y),
                      std::atan2(y, x) * 180.0F / std::numbers::pi_v<float>);
}

}  // namespace

std::array<std::uint8_t, 3> to_srgb(const Color& color) {
    return {to_srgb(color[0]), to_srgb(color[1]), to_srgb(color[2])};
}

Color from_srgb(float red, float green, float blue) {
    return {from_srgb(red), from_srgb(green), from_srgb(blue)};
}

Color from_oklch(float lightness, float chroma, float hue) {
    const float angle = hue * std::numbers::pi_v<float> / 180.0F;
    const float a = chroma * std::cos(angle);
    const float b = chroma * std::sin(angle);
    const float l = lightness + 0.3963377774F * a + 0.2158037573F * b;
    const float m = lightness - 0.1055613458F * a - 0.0638541728F * b;
    const float s = lightness - 0.0894841775F * a - 1.2914855480F * b;
    const Eigen::Vector3f lms(l * l * l, m * m * m, s * s * s);
    const Eigen::Matrix3f to_rgb{{4.0767416621F, -3.3077115913F, 0.2309699292F},
                                 {-1.2684380046F, 2.6097574011F, -0.3413193965F},
                                 {-0.0041960863F, -0.7034186147F, 1.7076147010F}};
    const Eigen::Vector3f rgb = to_rgb * lms;
    return rgb.cwiseMax(0.0F).cwiseMin(1.0F);
}

Color map_color(ColorMap map, double value) {
    const std::array<Stop, 5>& stops = map == ColorMap::Heat ? kHeat : kDiverging;
    const float place =
        static_cast<float>(std::clamp(value, 0.0, 1.0)) * static_cast<float>(stops.size() - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(place), stops.size() - 2);
    return mix(stops[i], stops[i + 1], place - static_cast<float>(i));
}

Color body_color(std::size_t i) {
    return color_of(kBodies[i % kBodies.size()]);
}

}  // namespace pent::viewer
