#include "written_law.h"

#include <cmath>
#include <set>

namespace pent::scene_fuzz {

namespace {

// Keys that are written in other words: a preset as what it stands for, Young's modulus and
// Poisson's ratio as mu and lambda, and the path of a mesh from another folder.
const std::set<std::string>& other_words() {
    static const std::set<std::string> kKeys = {
        "solver.preset", "body.material.young",        "body.material.poisson",
        "body.mesh",     "body.region.material.young", "body.region.material.poisson"};
    return kKeys;
}

// Directions come back at length 1.
bool is_same_direction(const Json& a, const Json& b) {
    double squared = 0;
    double difference = 0;
    for (const Json& entry : a) {
        squared += std::pow(entry.get<double>(), 2);
    }
    for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) {
        difference += std::abs(a[i].get<double>() / std::sqrt(squared) - b[i].get<double>());
    }
    return a.size() == b.size() && difference < 1e-12;  // some roundings
}

std::string difference(const Json& value, const Json& written, const std::string& path) {
    if (other_words().contains(path)) {
        return "";
    }
    if (value.is_object() && written.is_array() && written.size() == 1) {
        return difference(value, written[0], path);  // one table is a list of one
    }
    if (value.is_object() && written.is_object()) {
        for (const auto& [key, entry] : value.items()) {
            const std::string below = path.empty() ? key : path + "." + key;
            const bool may_lack = entry.is_array() && entry.empty();
            if (!written.contains(key) && !may_lack && !other_words().contains(below)) {
                return below + " is not written";
            }
            if (const std::string found = difference(entry, written.value(key, Json()), below);
                !found.empty() && !may_lack) {
                return found;
            }
        }
        return "";
    }
    const bool is_list = value.is_array() && !value.empty() && value.front().is_structured();
    if (is_list && written.is_array() && value.size() == written.size()) {
        for (std::size_t i = 0; i < value.size(); ++i) {
            if (const std::string found = difference(value[i], written[i], path); !found.empty()) {
                return found;
            }
        }
        return "";
    }
    const bool is_direction = path.ends_with(".normal") || path.ends_with(".up");
    const bool is_same = is_direction ? is_same_direction(value, written) : value == written;
    return is_same ? "" : path + " is " + value.dump() + ", written as " + written.dump();
}

}  // namespace

std::string what_is_lost(const Json& scene, const Json& written) {
    return difference(scene, written, "");
}

}  // namespace pent::scene_fuzz
