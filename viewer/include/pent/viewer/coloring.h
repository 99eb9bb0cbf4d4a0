#pragma once

#include <pent/pent_file.h>
#include <pent/viewer/color.h>
#include <pent/viewer/run_folder.h>
#include <pent/viewer/surface.h>

#include <Eigen/Core>

#include <cstddef>
#include <string_view>
#include <vector>

namespace pent::viewer {

/// What the color of a surface tells.
enum class ColorBy { Body, W, Speed, Strain, Force, Reaction, EnergyDensity };

/// All of them.
[[nodiscard]] std::vector<ColorBy> all_colorings();

/// "body", "w", "speed", "strain", "force", "reaction" or "energy_density".
[[nodiscard]] std::string_view name_of(ColorBy by);

/// The quantity with its unit, for a color bar: "speed, m/s".
[[nodiscard]] std::string_view title_of(ColorBy by);

/// The colors in which a quantity is shown.
[[nodiscard]] ColorMap color_map_of(ColorBy by);

/// The values that get the first and the last color.
struct ColorRange {
    double low = 0;
    double high = 1;

    /// The share of the way from low to high. Where both are equal it is the middle of a quantity
    /// with two sides, and the beginning of one that counts from zero.
    [[nodiscard]] double place(double value, ColorBy by) const {
        const double alone = color_map_of(by) == ColorMap::Diverging ? 0.5 : 0;
        return high > low ? (value - low) / (high - low) : alone;
    }
};

/// The quantity at the vertices of a body's mesh; zero for ColorBy::Body.
///
/// Throws an Error if the frame does not have it, with what a scene needs for it.
template <int Dim>
[[nodiscard]] Eigen::VectorXd vertex_values(const Body<Dim>& body,
                                            const Frame<Dim>& frame,
                                            ColorBy by);

/// Whether frames may lack a quantity, and this one does not have it.
template <int Dim>
[[nodiscard]] bool lacks(const Frame<Dim>& frame, ColorBy by) {
    switch (by) {
        case ColorBy::Force:
            return frame.contact_forces.cols() == 0;
        case ColorBy::Reaction:
        case ColorBy::EnergyDensity:
            return find_field(frame, name_of(by)) == nullptr;
        default:
            return false;
    }
}

/// Colors of the vertices of a surface, 3 x vertices, linear light.
///
/// @param values  At the vertices of the surface.
/// @param body    Which body it is, for ColorBy::Body.
[[nodiscard]] Eigen::Matrix3Xf surface_colors(const Eigen::VectorXd& values,
                                              ColorBy by,
                                              const ColorRange& range,
                                              std::size_t body);

/// The range that suits a quantity: speed and strain start at zero, and all leave out the upmost
/// hundredth of the values, so that one bad element does not take the colors from all others.
[[nodiscard]] ColorRange suitable_range(const Eigen::VectorXd& values, ColorBy by);

/// The smallest range around two.
[[nodiscard]] ColorRange joined(const ColorRange& a, const ColorRange& b);

}  // namespace pent::viewer
