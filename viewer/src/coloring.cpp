#include "pent/viewer/coloring.h"

#include <pent/error.h>
#include <pent/nearest_name.h>
#include <pent/printable.h>
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

std::string name_of(const ColorBy& by) {
    switch (by.kind) {
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
            return "energy_density";
        case ColorBy::Field:
            break;
    }
    return by.field;
}

ColorBy coloring_of(std::string_view name) {
    for (const ColorBy& by : all_colorings()) {
        if (name_of(by) == name) {
            return by;
        }
    }
    ColorBy by = ColorBy::Field;
    by.field = name;
    return by;
}

std::string title_of(const ColorBy& by, int dimension) {
    switch (by.kind) {
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
            return "energy_density, J/m^" + std::to_string(dimension);
        case ColorBy::Field:
            break;
    }
    return by.field;
}

ColorMap color_map_of(const ColorBy& by) {
    return by == ColorBy::W ? ColorMap::Diverging : ColorMap::Heat;
}

namespace {

template <int Dim>
[[noreturn]] void refuse_field(const Body<Dim>& body,
                               const Frame<Dim>& frame,
                               const std::string& name) {
    std::vector<ColorBy> all = all_colorings();
    const std::vector<ColorBy> fields = field_colorings(body, frame);
    all.insert(all.end(), fields.begin(), fields.end());
    std::vector<std::string> names;
    std::string listed;
    for (const ColorBy& by : all) {
        names.push_back(name_of(by));
        listed += (listed.empty() ? "" : ", ") + names.back();
    }
    const std::string meant = nearest_name(name, names);
    throw Error("frame " + std::to_string(frame.frame) + " of \"" + body.name
                + "\" has nothing called \"" + printable(name) + "\" to color by; "
                + (meant.empty() ? "there are " : "did you mean \"" + meant + "\"? There are ")
                + listed);
}

// Of the frame, or else of the mesh; null if neither has it.
template <int Dim>
const VertexField* field_of(const Body<Dim>& body,
                            const Frame<Dim>& frame,
                            const std::string& name) {
    for (const std::vector<VertexField>* fields : {&frame.fields, &body.fields}) {
        for (const VertexField& field : *fields) {
            if (field.name == name) {
                return &field;
            }
        }
    }
    return nullptr;
}

template <int Dim>
Eigen::VectorXd field_values(const Body<Dim>& body,
                             const Frame<Dim>& frame,
                             const std::string& name) {
    const VertexField* field = field_of(body, frame, name);
    if (field == nullptr) {
        refuse_field(body, frame, name);
    }
    return field->values.rows() == 1 ? Eigen::VectorXd(field->values.transpose())
                                     : lengths(field->values);
}

}  // namespace

template <int Dim>
bool lacks(const Body<Dim>& body, const Frame<Dim>& frame, const ColorBy& by) {
    switch (by.kind) {
        case ColorBy::Force:
            return frame.contact_forces.cols() == 0;
        case ColorBy::Reaction:
        case ColorBy::EnergyDensity:
            return field_of(body, frame, name_of(by)) == nullptr;
        default:
            return false;
    }
}

template <int Dim>
std::vector<ColorBy> field_colorings(const Body<Dim>& body, const Frame<Dim>& frame) {
    std::vector<ColorBy> found;
    for (const std::vector<VertexField>* fields : {&frame.fields, &body.fields}) {
        for (const VertexField& field : *fields) {
            const ColorBy by = coloring_of(field.name);
            if (by.kind == ColorBy::Field
                && std::find(found.begin(), found.end(), by) == found.end()) {
                found.push_back(by);
            }
        }
    }
    return found;
}

template <int Dim>
Eigen::VectorXd vertex_values(const Body<Dim>& body, const Frame<Dim>& frame, const ColorBy& by) {
    if (lacks(body, frame, by)) {
        const bool is_force = by == ColorBy::Force;
        const std::string name(is_force ? "contact_force" : name_of(by));
        throw Error("frame " + std::to_string(frame.frame) + " of \"" + body.name + "\" has no "
                    + (is_force ? "contact forces" : name)
                    + " to color by; run the scene with [output] vertex = [\"" + name + "\"]");
    }
    switch (by.kind) {
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
            return field_values(body, frame, name_of(by));
        case ColorBy::Field:
            return field_values(body, frame, by.field);
        case ColorBy::Body:
            break;
    }
    return Eigen::VectorXd::Zero(frame.positions.cols());
}

Eigen::Matrix3Xf surface_colors(const Eigen::VectorXd& values,
                                const ColorBy& by,
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

ColorRange suitable_range(const Eigen::VectorXd& values, const ColorBy& by) {
    if (values.size() == 0 || by == ColorBy::Body) {
        return {0, 0};
    }
    if (by == ColorBy::W) {
        return {values.minCoeff(), values.maxCoeff()};
    }
    std::vector<double> sorted(values.begin(), values.end());
    const auto behind = [&](std::size_t hundredths) {
        const auto place =
            sorted.begin() + static_cast<std::ptrdiff_t>((sorted.size() - 1) * hundredths / 100);
        std::nth_element(sorted.begin(), place, sorted.end());
        return *place;
    };
    return {by.kind == ColorBy::Field ? behind(1) : 0, behind(99)};
}

ColorRange joined(const ColorRange& a, const ColorRange& b) {
    return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

template bool lacks<3>(const Body<3>&, const Frame<3>&, const ColorBy&);
template bool lacks<4>(const Body<4>&, const Frame<4>&, const ColorBy&);
template Eigen::VectorXd vertex_values<3>(const Body<3>&, const Frame<3>&, const ColorBy&);
template Eigen::VectorXd vertex_values<4>(const Body<4>&, const Frame<4>&, const ColorBy&);
template std::vector<ColorBy> field_colorings<3>(const Body<3>&, const Frame<3>&);
template std::vector<ColorBy> field_colorings<4>(const Body<4>&, const Frame<4>&);

}  // namespace pent::viewer
