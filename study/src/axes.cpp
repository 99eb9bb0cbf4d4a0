#include "axes.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/nearest_name.h>
#include <pent/runs/scene_keys.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <sstream>
#include <string_view>
#include <utility>

namespace pent::study {

namespace {

constexpr const char* kOwnAxes[] = {"dt", "preset", "contact", "layers", "subdivide"};

std::string place_of(const Setting& setting) {
    return "--vary " + setting.axis + "=" + setting.value;
}

// What stands between commas, but those within a list or a table.
std::vector<std::string> values_of(const std::string& text) {
    std::vector<std::string> values(1);
    int depth = 0;
    for (const char c : text) {
        depth += c == '[' || c == '{' ? 1 : 0;
        depth -= c == ']' || c == '}' ? 1 : 0;
        if (c == ',' && depth == 0) {
            values.emplace_back();
        } else {
            values.back() += c;
        }
    }
    return values;
}

// The path of the key of the scene that an axis stands for.
std::string path_of(const std::string& axis) {
    if (axis == "dt") {
        return "scene.steps_per_frame";
    }
    if (axis == "contact") {
        return "contact.model";
    }
    return axis.find('.') == std::string::npos ? "solver." + axis : axis;
}

// The name of an axis, however it was spelled: "tolerance" for "solver.tolerance".
std::string name_of(const std::string& path) {
    for (const std::string& key : runs::scene_keys()) {
        const std::string name = key == "contact.model" ? "contact" : key.substr(key.find('.') + 1);
        if (key == path && path_of(name) == path) {
            return name;
        }
    }
    return path;
}

// What might have been meant by an axis that is not known.
std::string guess(const std::string& axis, const std::vector<std::string>& keys) {
    const std::string end = "." + axis.substr(axis.rfind('.') + 1);
    std::string same;
    for (const std::string& key : keys) {
        if (key.ends_with(end)) {
            same += (same.empty() ? "" : " or ") + key;
        }
    }
    if (!same.empty()) {
        return "did you mean " + same + "?";
    }
    constexpr std::string_view kSolver = "solver.";
    std::vector<std::string> known(std::begin(kOwnAxes), std::end(kOwnAxes));
    for (const std::string& key : keys) {
        known.push_back(key.starts_with(kSolver) ? key.substr(kSolver.size()) : key);
    }
    const std::string nearest = nearest_name(axis, known);
    return nearest.empty() ? "expected dt, layers, subdivide, contact, a key of [solver], or the "
                             "path of another key, as attachment.stiffness"
                           : "did you mean " + nearest + "?";
}

void check_axis(const std::string& axis) {
    if (axis == "scene.frames" || axis == "scene.frames_per_second") {
        throw Error("--vary " + axis
                    + ": runs are compared with the reference frame by frame, so all must have the"
                      " same; set it in the scene, or study fewer frames by --frames");
    }
    if (axis == "body.mesh" || axis == "body.recipe") {
        throw Error("--vary " + axis
                    + ": runs are compared on meshes of one body; vary layers or subdivide, which"
                      " change what the recipe of each body says");
    }
    if (axis == "scene.steps_per_frame") {
        throw Error("--vary " + axis + ": vary dt instead, as in dt=1/30,1/60");
    }
    const std::vector<std::string> keys = runs::scene_keys();
    if (!is_mesh_axis(axis) && std::ranges::count(keys, path_of(axis)) == 0) {
        throw Error("--vary " + axis + ": is not known; " + guess(axis, keys));
    }
}

// The number of steps in a frame that a time step makes.
std::string steps_of(const simulator::Scene& scene, const std::string& dt) {
    const double steps = 1 / (scene.frames_per_second * parse_seconds(dt));
    const double whole = std::clamp(std::round(steps), 1.0, 1e15);
    if (std::abs(steps - whole) > 1e-6 * whole) {
        std::ostringstream nearest;
        nearest << "1/" << scene.frames_per_second * whole;
        throw Error("dt=" + dt + ": does not divide the time between two frames (1/"
                    + std::to_string(scene.frames_per_second)
                    + " s) into whole steps; the nearest that does is " + nearest.str());
    }
    return formatted("%.0f", whole);
}

}  // namespace

std::string settings_text(const Settings& settings) {
    std::string text;
    for (const Setting& setting : settings) {
        text += (text.empty() ? "" : " ") + setting.axis + "=" + setting.value;
    }
    return text.empty() ? "as it is" : text;
}

std::string file_name(const Settings& settings) {
    std::string name;
    for (const Setting& setting : settings) {
        name += (name.empty() ? "" : ".") + setting.axis + "-" + setting.value;
    }
    for (char& c : name) {
        const bool is_safe =
            std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '.';
        c = is_safe ? c : '_';
    }
    return name.empty() ? "scene" : name;
}

Axis parse_axis(const std::string& text) {
    const auto equals = text.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == text.size()) {
        throw Error("--vary " + text + ": expected a name and values, as in dt=1/30,1/60");
    }
    Axis axis{.name = name_of(text.substr(0, equals))};
    for (const std::string& value : values_of(text.substr(equals + 1))) {
        if (value.empty()) {
            throw Error("--vary " + text + ": one of the values is empty");
        }
        if (std::find(axis.values.begin(), axis.values.end(), value) != axis.values.end()) {
            throw Error(formatted("--vary %s: %s is there twice", text.c_str(), value.c_str()));
        }
        axis.values.push_back(value);
    }
    return axis;
}

std::vector<Settings> combinations(const std::vector<Axis>& axes) {
    std::vector<Settings> all = {{}};
    for (const Axis& axis : axes) {
        std::vector<Settings> longer;
        for (const Settings& settings : all) {
            for (const std::string& value : axis.values) {
                longer.push_back(settings);
                longer.back().push_back({axis.name, value});
            }
        }
        all = std::move(longer);
    }
    return all;
}

bool is_mesh_axis(const std::string& name) {
    return name == "layers" || name == "subdivide";
}

double parse_seconds(const std::string& text) {
    char* end = nullptr;
    double seconds = std::strtod(text.c_str(), &end);
    if (*end == '/') {
        const char* divisor = end + 1;
        seconds /= std::strtod(divisor, &end);
        end = end == divisor ? const_cast<char*>(divisor - 1) : end;
    }
    if (end == text.c_str() || *end != '\0' || !(seconds > 0) || !std::isfinite(seconds)) {
        throw Error("dt=" + text + ": is not a time; expected seconds, as in 1/60 or 0.01");
    }
    return seconds;
}

simulator::Scene with_settings(simulator::Scene scene, const Settings& settings) {
    std::vector<runs::KeyValue> keys;
    for (const Setting& setting : settings) {
        check_axis(setting.axis);
        if (!is_mesh_axis(setting.axis)) {
            const bool is_dt = setting.axis == "dt";
            keys.push_back({.path = path_of(setting.axis),
                            .value = is_dt ? steps_of(scene, setting.value) : setting.value});
        }
    }
    try {
        return runs::with_keys(std::move(scene), keys);
    } catch (const Error& error) {
        throw Error((settings.size() == 1 ? place_of(settings[0]) : "these settings") + ": "
                    + error.what());
    }
}

void check_setting(simulator::Scene scene, const Setting& setting) {
    const bool is_count = !setting.value.empty() && setting.value.size() < 7
                          && setting.value.find_first_not_of("0123456789") == std::string::npos
                          && setting.value.find_first_not_of('0') != std::string::npos;
    if (is_mesh_axis(setting.axis) && !is_count) {
        throw Error(place_of(setting) + ": expected a whole number of at least 1");
    }
    // From where every single value is possible.
    scene.solver.integrator = simulator::Integrator::NewtonEuler;
    if (scene.contact) {
        scene.contact->model = simulator::ContactModel::Penalty;
    }
    static_cast<void>(with_settings(std::move(scene), {setting}));
}

}  // namespace pent::study
