#include "pent/viewer/coloring.h"

#include <pent/error.h>
#include <pent/viewer/attributes.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace pent::viewer {

std::vector<ColorBy> all_colorings() {
    return {ColorBy::Body,  ColorBy::W,        ColorBy::Speed,        ColorBy::Strain,
            ColorBy::Force, ColorBy::Reaction, ColorBy::EnergyDensity};
}

std::string_view name_of(ColorBy by) {
    switch (by) {
        case ColorBy::Body:
            return "body";
        case ColorBy::W:
            return "w";
        case ColorBy::Speed:
            return "speed";
        case ColorBy::Strain:
            return "strain";
        case ColorBy::Force:
            return "force";
        case ColorBy::Reaction:
            return "reaction";
        case ColorBy::EnergyDensity:
            break;
    }
    return "energy_density";
}

std::string_view title_of(ColorBy by) {
    switch (by) {
        case ColorBy::Body:
            return "";
        case ColorBy::W:
            return "w, m";
        case ColorBy::Speed:
            return "speed, m/s";
        case ColorBy::Strain:
            return "strain";
        case ColorBy::Force:
            return "contact force, N";
        case ColorBy::Reaction:
            return "reaction, N";
        case ColorBy::EnergyDensity:
            break;
    }
    return "energy_density, J/m^n";
}

ColorMap color_map_of(ColorBy by) {
    return by == ColorBy::W ? ColorMap::Diverging : ColorMap::Heat;
}

template <int Dim>
Eigen::VectorXd vertex_values(const Body<Dim>& body, const Frame<Dim>& frame, ColorBy by) {
    if (lacks(frame, by)) {
        const bool is_force = by == ColorBy::Force;
        const std::string name(is_force ? "contact_force" : name_of(by));
        throw Error("frame " + std::to_string(frame.frame) + " of \"" + body.name + "\" has no "
                    + (is_force ? "contact forces" : name)
                    + " to color by; run the scene with [output] vertex = [\"" + name + "\"]");
    }
    switch (by) {
        case ColorBy::W:
            return vertex_w<Dim>(frame.positions);
        case ColorBy::Speed:
            return vertex_speed<Dim>(frame);
        case ColorBy::Strain:
            return vertex_strain<Dim>(body.mesh, frame.positions);
        case ColorBy::Force:
            return vertex_force<Dim>(frame);
        case ColorBy::Reaction:
        case ColorBy::EnergyDensity:
            return find_field(frame, name_of(by))->values.colwise().norm().transpose();
        case ColorBy::Body:
            break;
    }
    return Eigen::VectorXd::Zero(frame.positions.cols());
}

Eigen::Matrix3Xf surface_colors(const Eigen::VectorXd& values,
                                ColorBy by,
                                const ColorRange& range,
                                std::size_t body) {
    Eigen::Matrix3Xf colors(3, values.size());
    if (by == ColorBy::Body) {
        colors.colwise() = body_color(body);
        return colors;
    }
    // Looking up a fine table is much faster than the map, and its steps cannot be seen.
    constexpr int kSteps = 1024;
    Eigen::Matrix3Xf table(3, kSteps + 1);
    for (int i = 0; i <= kSteps; ++i) {
        table.col(i) = map_color(color_map_of(by), static_cast<double>(i) / kSteps);
    }
    for (Eigen::Index v = 0; v < values.size(); ++v) {
        const double place = std::clamp(range.place(values[v], by), 0.0, 1.0);
        colors.col(v) = table.col(std::lround(place * kSteps));
    }
    return colors;
}

ColorRange suitable_range(const Eigen::VectorXd& values, ColorBy by) {
    if (values.size() == 0 || by == ColorBy::Body) {
        return {0, 0};
    }
    if (by == ColorBy::W) {
        return {values.minCoeff(), values.maxCoeff()};
    }
    std::vector<double> sorted(values.begin(), values.end());
    const auto nearly_all =
        sorted.begin() + static_cast<std::ptrdiff_t>((sorted.size() - 1) * 99 / 100);
    std::nth_element(sorted.begin(), nearly_all, sorted.end());
    return {0, *nearly_all};
}

ColorRange joined(const ColorRange& a, const ColorRange& b) {
    return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

template Eigen::VectorXd vertex_values<3>(const Body<3>&, const Frame<3>&, ColorBy);
template Eigen::VectorXd vertex_values<4>(const Body<4>&, const Frame<4>&, ColorBy);

}  // namespace pent::viewer
