#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>

namespace pent::viewer {

/// Linear light, red green blue, 0..1 for what a screen can show.
using Color = Eigen::Vector3f;

/// Eight bits a channel in the sRGB encoding; out of range is clamped.
[[nodiscard]] std::array<std::uint8_t, 3> to_srgb(const Color& color);

/// From sRGB channels 0..1, as colors are usually written.
[[nodiscard]] Color from_srgb(float red, float green, float blue);

/// A color of given lightness (0..1), chroma (0 gray .. about 0.3) and hue (degrees), in the Oklch
/// form of the Oklab space, where equal steps look equal. Source: [ottosson2020].
[[nodiscard]] Color from_oklch(float lightness, float chroma, float hue);

/// Colors for values 0..1.
enum class ColorMap {
    Heat,       ///< Blue over yellow to red: from little to much.
    Diverging,  ///< Teal over pale to orange: from one side through the middle to the other.
};

/// The color of a value; out of 0..1 is clamped.
[[nodiscard]] Color map_color(ColorMap map, double value);

/// A color to tell the i-th body by; eight different ones, then over again.
[[nodiscard]] Color body_color(std::size_t i);

}  // namespace pent::viewer
