#include "axes.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/nearest_name.h>
#include <pent/runs/scene_file.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <sstream>

namespace pent::study {

namespace {

constexpr const char* kText = "settings";  // what messages call the text that settings are put into

// Where a setting goes: the head of its section as scene texts have it, and its key.
struct Place {
    std::string head;
    std::string key;
};

Place place_in(const std::string& scene, const std::string& axis) {
    if (axis == "contact") {
        return {"[contact]", "model"};
    }
    const auto dot = axis.find('.');
    if (dot == std::string::npos) {
        return {"[solver]", axis};
    }
    const std::string block = axis.substr(0, dot);
    const bool is_list = scene.find("\n[[" + block + "]]\n") != std::string::npos;
    return {is_list ? "[[" + block + "]]" : "[" + block + "]", axis.substr(dot + 1)};
}

// The keys that a section of a scene text has, in its order; empty if there is no such section.
std::vector<std::string> keys_of(const std::string& scene, std::string_view head) {
    std::vector<std::string> keys;
    std::istringstream lines(scene);
    std::string line;
    bool is_inside = false;
    while (std::getline(lines, line)) {
        if (!line.empty() && line[0] == '[') {
            is_inside = line == head;
        } else if (is_inside && line.find(" = ") != std::string::npos) {
            keys.push_back(line.substr(0, line.find(" = ")));
        }
    }
    return keys;
}

std::string place_of(const Setting& setting) {
    return "--vary " + setting.axis + "=" + setting.value;
}

// The text of a scene with another value for a key of a section, which is there.
std::string replaced(const std::string& scene,
                     std::string_view head,
                     const std::string& key,
                     const std::string& value) {
    std::string text;
    std::istringstream lines(scene);
    std::string line;
    bool is_inside = false;
    while (std::getline(lines, line)) {
        if (!line.empty() && line[0] == '[') {
            is_inside = line == head;
        }
        const std::string start = key + " = ";
        if (is_inside && line.rfind(start, 0) == 0) {
            const bool is_text = line.size() > start.size() && line[start.size()] == '"';
            const std::size_t quotes = is_text ? 1 : 0;
            line.resize(start.size());
            line.append(quotes, '"').append(value).append(quotes, '"');
        }
        text += line + "\n";
    }
    return text;
}

// A message about the text that settings were put into, without its lines and columns, which nobody
// sees.
std::string without_place(std::string message) {
    const std::size_t begin =
        message.find(kText) == 0 ? message.find_first_not_of(":0123456789", std::strlen(kText)) : 0;
    return message.substr(begin == std::string::npos ? 0 : message.find_first_not_of(' ', begin));
}

simulator::Scene with_dt(simulator::Scene scene, const std::string& value) {
    const double steps = 1 / (scene.frames_per_second * parse_seconds(value));
    const double whole = std::max(1.0, std::round(steps));
    if (std::abs(steps - whole) > 1e-6 * whole || whole > 1e6) {
        std::ostringstream nearest;
        nearest << "1/" << scene.frames_per_second * whole;
        throw Error("dt=" + value + ": does not divide the time between two frames (1/"
                    + std::to_string(scene.frames_per_second)
                    + " s) into whole steps; the nearest that does is " + nearest.str());
    }
    scene.steps_per_frame = static_cast<int>(whole);
    return scene;
}

// The text of a scene with a setting of one key, in every section that has it.
std::string with_key(const std::string& text, const Setting& setting) {
    const auto& [head, key] = place_in(text, setting.axis);
    std::vector<std::string> keys = keys_of(text, head);
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
        if (keys.empty()) {
            throw Error("--vary " + setting.axis + ": the scene has no " + head);
        }
        keys.insert(keys.end(), {"dt", "preset", "contact", "layers", "subdivide"});
        const std::string nearest = nearest_name(setting.axis, keys);
        std::string known;
        for (const std::string& name : keys) {
            known += (known.empty() ? "" : ", ") + name;
        }
        throw Error("--vary " + setting.axis + ": is not known"
                    + (nearest.empty() ? "" : " (did you mean " + nearest + "?)")
                    + "; expected one of " + known);
    }
    return replaced(text, head, key, setting.value);
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
    Axis axis{.name = text.substr(0, equals)};
    std::istringstream values(text.substr(equals + 1));
    std::string value;
    while (std::getline(values, value, ',')) {
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

simulator::SolverOptions preset_solver(const simulator::Scene& scene, const Setting& preset) {
    simulator::Scene bodies;
    bodies.dimension = scene.dimension;
    bodies.gravity = scene.gravity;
    bodies.bodies = scene.bodies;
    std::string text = runs::scene_text(bodies);
    text.replace(text.find("\n[solver]\n"), std::string::npos,
                 "\n[solver]\npreset = \"" + preset.value + "\"\n");
    try {
        return runs::parse_scene(text, kText, "").solver;
    } catch (const Error& error) {
        throw Error(place_of(preset) + ": " + without_place(error.what()));
    }
}

simulator::Scene with_settings(simulator::Scene scene, const Settings& settings) {
    std::string place = "these settings";
    for (const Setting& setting : settings) {
        place = settings.size() == 1 ? place_of(setting) : place;
        if (setting.axis == "preset") {
            scene.solver = preset_solver(scene, setting);
        } else if (setting.axis == "dt") {
            scene = with_dt(std::move(scene), setting.value);
        }
    }
    std::string text = runs::scene_text(scene);
    for (const Setting& setting : settings) {
        if (!is_mesh_axis(setting.axis) && setting.axis != "preset" && setting.axis != "dt") {
            text = with_key(text, setting);
        }
    }
    try {
        return runs::parse_scene(text, kText, "");
    } catch (const Error& error) {
        throw Error(place + ": " + without_place(error.what()));
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
