#include "shrink.h"

#include "meshes.h"
#include "random.h"

#include <pent/error.h>

#include <algorithm>
#include <cmath>

namespace pent::scene_fuzz {

namespace {

using Pointer = Json::json_pointer;

void add(std::vector<Json>& scenes, Json scene) {
    scenes.push_back(std::move(scene));
}

// The entries of a list that name no body that has gone.
Json without(const Json& list, const Json& name) {
    Json left = Json::array();
    for (const Json& entry : list.is_object() ? Json::array({list}) : list) {
        const bool is_named = std::any_of(entry.begin(), entry.end(),
                                          [&](const Json& value) { return value == name; });
        if (!is_named) {
            left.push_back(entry);
        }
    }
    return left;
}

// Bodies go with all that names them.
void add_without_bodies(const Json& scene, std::vector<Json>& scenes) {
    for (std::size_t i = 0; i < scene["body"].size() && scene["body"].size() > 1; ++i) {
        Json less = scene;
        const Json name = less["body"][i].value("name", Json());
        less["body"].erase(i);
        for (const char* list : {"constraint", "load", "attachment"}) {
            less[list] = without(scene.value(list, Json::array()), name);
        }
        for (const char* pairs : {"ignore", "only"}) {
            if (less.contains("contact") && less["contact"].contains(pairs)) {
                less["contact"][pairs] = without(less["contact"][pairs], name);
            }
        }
        add(scenes, less);
    }
}

void add_without_entries(const Json& scene, std::vector<Json>& scenes) {
    for (const auto& [name, block] : scene.items()) {
        if (name == "scene" || name == "body") {
            continue;
        }
        if (block.is_object()) {
            Json less = scene;
            less.erase(name);
            add(scenes, less);
        }
        for (std::size_t i = 0; block.is_array() && i < block.size(); ++i) {
            Json less = scene;
            less[name].erase(i);
            add(scenes, less);
        }
    }
}

// Places of all values below a node, tables and lists included, outer ones first.
void collect(const Json& node, const Pointer& at, std::vector<Pointer>& places) {
    if (!at.empty()) {
        places.push_back(at);
    }
    if (node.is_object()) {
        for (const auto& [key, value] : node.items()) {
            collect(value, at / key, places);
        }
    } else if (node.is_array() && !node.empty() && node.front().is_structured()) {
        for (std::size_t i = 0; i < node.size(); ++i) {
            collect(node[i], at / i, places);
        }
    } else if (node.is_array()) {
        for (std::size_t i = 0; i < node.size(); ++i) {
            places.push_back(at / i);
        }
    }
}

void add_without_key(const Json& scene, const Pointer& place, std::vector<Json>& scenes) {
    const Json& parent = scene[place.parent_pointer()];
    const bool is_entry = parent.is_array();
    if (place.back() == "scene" || place.back() == "frames") {
        return;  // there would be a hundred
    }
    if (is_entry && (!parent.front().is_structured() || parent.size() == 1)) {
        return;  // of a vector
    }
    Json less = scene;
    if (is_entry) {
        less[place.parent_pointer()].erase(static_cast<std::size_t>(std::stoul(place.back())));
    } else {
        less[place.parent_pointer()].erase(place.back());
    }
    add(scenes, less);
}

void add_with(const Json& scene,
              const Pointer& place,
              const Json& value,
              std::vector<Json>& scenes) {
    if (scene[place] != value) {
        Json other = scene;
        other[place] = value;
        add(scenes, other);
    }
}

void add_simpler_mesh(const Json& scene, const Pointer& place, std::vector<Json>& scenes) {
    const MeshName mesh = parse_mesh_name(scene[place]);
    const auto add_mesh = [&](const MeshName& name) {
        add_with(scene, place, text_of(name), scenes);
    };
    MeshName box = mesh;
    box.kind = "box";
    add_mesh(box);
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(mesh.dimension); ++axis) {
        MeshName fewer = mesh;
        fewer.count[axis] = std::max(1, mesh.count[axis] / 2);
        add_mesh(fewer);
    }
    MeshName cube = mesh;
    cube.size.fill(mesh.size[0]);
    add_mesh(cube);
}

void add_simpler_value(const Json& scene, const Pointer& place, std::vector<Json>& scenes) {
    const Json& value = scene[place];
    if (value.is_number_integer()) {
        const int whole = value;
        add_with(scene, place, whole / 2, scenes);
        add_with(scene, place, whole - 1, scenes);
    } else if (value.is_number_float()) {
        const double number = value;
        add_with(scene, place, 0.0, scenes);
        add_with(scene, place, 1.0, scenes);
        const double scale =
            number == 0 ? 1 : std::pow(10, std::floor(std::log10(std::abs(number))));
        add_with(scene, place, Random::short_of(std::round(number / scale) * scale), scenes);
    } else if (value == true) {
        add_with(scene, place, false, scenes);
    } else if (place.back() == "mesh") {
        add_simpler_mesh(scene, place, scenes);
    }
}

}  // namespace

std::vector<Json> simpler_scenes(const Json& scene) {
    std::vector<Json> scenes;
    add_without_bodies(scene, scenes);
    add_without_entries(scene, scenes);
    std::vector<Pointer> places;
    collect(scene, Pointer(), places);
    for (const Pointer& place : places) {
        add_without_key(scene, place, scenes);
    }
    for (const Pointer& place : places) {
        add_simpler_value(scene, place, scenes);
    }
    return scenes;
}

Json shrink(const Json& scene, const std::function<bool(const Json&)>& fails, int tries) {
    Json least = scene;
    // After a step that holds, the steps behind it are tried on the simpler scene before the first
    // again: what could not be left out a moment ago can seldom be left out now.
    std::size_t next = 0;
    std::size_t since_last = 0;
    std::vector<Json> steps = simpler_scenes(least);
    while (tries > 0 && since_last < steps.size()) {
        next %= steps.size();
        const Json& candidate = steps[next];
        const bool is_simpler = [&] {
            try {
                return fails(candidate);
            } catch (const Error&) {  // of meshes that cannot be made
                return false;
            } catch (const Json::exception&) {  // of keys that every scene has
                return false;
            }
        }();
        --tries;
        if (is_simpler) {
            least = Json(candidate);
            steps = simpler_scenes(least);
            since_last = 0;
        } else {
            ++next;
            ++since_last;
        }
    }
    return least;
}

}  // namespace pent::scene_fuzz
