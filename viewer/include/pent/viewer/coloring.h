#pragma once

#include <pent/pent_file.h>
#include <pent/viewer/color.h>
#include <pent/viewer/run_folder.h>
#include <pent/viewer/surface.h>

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace pent::viewer {

/// What the color of a surface tells.
struct ColorBy {
    enum Kind { Body, W, Speed, Strain, Force, Reaction, EnergyDensity, Field };

    ColorBy() = default;
    ColorBy(Kind what) : kind(what) {}  // NOLINT(google-explicit-constructor): stands for it

    Kind kind = Body;
    std::string field;  ///< Of a Field: the name of a quantity of frames or of meshes.

    bool operator==(const ColorBy&) const = default;
};

/// All kinds but fields.
[[nodiscard]] std::vector<ColorBy> all_colorings();

/// "body", "w", "speed", "strain", "force", "reaction", "energy_density", or the name of a field.
[[nodiscard]] std::string name_of(const ColorBy& by);

/// What has the name: a field, if it is none of the others.
[[nodiscard]] ColorBy coloring_of(std::string_view name);

/// The quantity with its unit, for a color bar: "speed, m/s"; of a field its name.
///
/// @param dimension  Of the bodies.
[[nodiscard]] std::string title_of(const ColorBy& by, int dimension);

/// The colors in which a quantity is shown.
[[nodiscard]] ColorMap color_map_of(const ColorBy& by);

/// The values that get the first and the last color.
struct ColorRange {
    double low = 0;
    double high = 1;

    /// The share of the way from low to high. Where both are equal it is the middle of a quantity
    /// with two sides, and the beginning of one that counts from zero.
    [[nodiscard]] double place(double value, const ColorBy& by) const {
        if (!(high > low)) {
            return color_map_of(by) == ColorMap::Diverging ? 0.5 : 0;
        }
        // By halves where the distance of the ends leaves the range of numbers.
        return std::isfinite(high - low) ? (value - low) / (high - low)
                                         : (value / 2 - low / 2) / (high / 2 - low / 2);
    }
};

/// The quantity at the vertices of a body's mesh; zero for ColorBy::Body. Fields are those of the
/// frame, or else of the mesh, vectors by their length.
///
/// Throws an Error if there is none, with what a scene needs for it, or which there are.
template <int Dim>
[[nodiscard]] Eigen::VectorXd vertex_values(const Body<Dim>& body,
                                            const Frame<Dim>& frame,
                                            const ColorBy& by);

/// Fields of a frame and of the mesh by their names, without those that are colorings of their own.
template <int Dim>
[[nodiscard]] std::vector<ColorBy> field_colorings(const Body<Dim>& body, const Frame<Dim>& frame);

/// Whether frames may lack a quantity that is no field, and neither this one nor its mesh has it.
template <int Dim>
[[nodiscard]] bool lacks(const Body<Dim>& body, const Frame<Dim>& frame, const ColorBy& by);

/// Colors of the vertices of a surface, 3 x vertices, linear light.
///
/// @param values  At the vertices of the surface.
/// @param body    Which body it is, for ColorBy::Body.
[[nodiscard]] Eigen::Matrix3Xf surface_colors(const Eigen::VectorXd& values,
                                              const ColorBy& by,
                                              const ColorRange& range,
                                              std::size_t body);

/// The range that suits a quantity: w goes from end to end. All others leave out the upmost
/// hundredth of the values, so that one bad element does not take the colors from all others; they
/// start at zero, fields behind the lowest hundredth.
[[nodiscard]] ColorRange suitable_range(const Eigen::VectorXd& values, const ColorBy& by);

/// The smallest range around two.
[[nodiscard]] ColorRange joined(const ColorRange& a, const ColorRange& b);

}  // namespace pent::viewer
