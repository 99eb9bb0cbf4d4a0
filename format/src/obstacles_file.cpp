#include "pent/obstacles_file.h"

#include "input_file.h"

#include <pent/error.h>
#include <pent/output_file.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace pent {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kVersion = 1;
constexpr std::array<std::string_view, 4> kKinds = {"half_space", "ball", "cavity", "bowl"};

template <int Dim>
using Vector = Eigen::Matrix<double, Dim, 1>;

// The numbers of a shape by their keys, in the order written.
template <int Dim, typename Visitor>
void for_each_key(HalfSpace<Dim>& plane, const Visitor& visit) {
    visit.unit("normal", plane.normal);
    visit.number("offset", plane.offset);
}

template <typename Visitor, typename Round>
void for_each_key_of_round(Round& round, const Visitor& visit) {
    visit.point("center", round.center);
    visit.length("radius", round.radius);
}

template <int Dim, typename Visitor>
void for_each_key(Ball<Dim>& ball, const Visitor& visit) {
    for_each_key_of_round(ball, visit);
}

template <int Dim, typename Visitor>
void for_each_key(Cavity<Dim>& cavity, const Visitor& visit) {
    for_each_key_of_round(cavity, visit);
}

template <int Dim, typename Visitor>
void for_each_key(Bowl<Dim>& bowl, const Visitor& visit) {
    for_each_key_of_round(bowl, visit);
    visit.unit("up", bowl.up);
}

struct Writer {
    Json& json;

    template <typename Vector>
    void unit(const char* key, const Vector& vector) const {
        json[key] = std::vector<double>(vector.begin(), vector.end());
    }
    template <typename Vector>
    void point(const char* key, const Vector& vector) const {
        unit(key, vector);
    }
    void number(const char* key, double value) const { json[key] = value; }
    void length(const char* key, double value) const { json[key] = value; }
};

struct Reader {
    const Json& json;
    const std::string& where;

    [[noreturn]] void fail(const char* key, const std::string& expected) const {
        throw Error(where + ": \"" + key + "\" is missing or out of range; expected " + expected);
    }
    void number(const char* key, double& value) const {
        const auto found = json.find(key);
        if (found == json.end() || !found->is_number() || !std::isfinite(found->get<double>())) {
            fail(key, "a finite number");
        }
        value = found->get<double>();
    }
    void length(const char* key, double& value) const {
        number(key, value);
        if (!(value > 0)) {
            fail(key, "a number above 0");
        }
    }
    template <typename Vector>
    void point(const char* key, Vector& vector) const {
        const std::string expected = std::to_string(vector.size()) + " finite numbers";
        const auto found = json.find(key);
        if (found == json.end() || !found->is_array()
            || found->size() != static_cast<std::size_t>(vector.size())) {
            fail(key, expected);
        }
        for (Eigen::Index i = 0; i < vector.size(); ++i) {
            const Json& entry = (*found)[static_cast<std::size_t>(i)];
            if (!entry.is_number() || !std::isfinite(entry.get<double>())) {
                fail(key, expected);
            }
            vector[i] = entry.get<double>();
        }
    }
    template <typename Vector>
    void unit(const char* key, Vector& vector) const {
        point(key, vector);
        if (!(std::abs(vector.stableNorm() - 1) <= 1e-9)) {
            fail(key, std::to_string(vector.size()) + " numbers, of length 1 together");
        }
    }
};

// In quotes and on one line, whatever it is.
std::string quoted(const std::string& text) {
    return Json(text).dump(-1, ' ', true, Json::error_handler_t::replace);
}

template <int Dim>
Obstacle<Dim> shape_of_kind(const std::string& kind, const std::string& where) {
    const std::array<Obstacle<Dim>, 4> shapes = {HalfSpace<Dim>{}, Ball<Dim>{}, Cavity<Dim>{},
                                                 Bowl<Dim>{}};
    for (std::size_t i = 0; i < kKinds.size(); ++i) {
        if (kind == kKinds[i]) {
            return shapes[i];
        }
    }
    throw Error(where + ": found an obstacle of kind " + quoted(kind)
                + "; expected half_space, ball, cavity or bowl; a newer pent-sim may have made it");
}

template <int Dim>
Json to_json(Obstacle<Dim> obstacle) {
    Json json;
    json["kind"] = kind_of<Dim>(obstacle);
    std::visit([&](auto& shape) { for_each_key(shape, Writer{json}); }, obstacle);
    return json;
}

template <int Dim>
Obstacle<Dim> from_json(const Json& json, const std::string& where) {
    const auto kind = json.find("kind");
    if (kind == json.end() || !kind->is_string()) {
        throw Error(where + ": found no kind; expected half_space, ball, cavity or bowl");
    }
    auto obstacle = shape_of_kind<Dim>(kind->get<std::string>(), where);
    std::visit([&](auto& shape) { for_each_key(shape, Reader{json, where}); }, obstacle);
    // A key more may say that it moves: drawn at rest it would be in the wrong place.
    const Json known = to_json<Dim>(obstacle);
    for (const auto& [key, value] : json.items()) {
        if (!known.contains(key)) {
            throw Error(where + ": found the key " + quoted(key)
                        + ", which is not known; a newer pent-sim may have made it");
        }
    }
    return obstacle;
}

// A key of the file's own; `value` is 0 where there is none or another kind of thing.
std::uint64_t count_of(const Json& json, const char* key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
}

}  // namespace

template <int Dim>
std::string_view kind_of(const Obstacle<Dim>& obstacle) {
    return kKinds[obstacle.index()];
}

template <int Dim>
void write_obstacles(const std::filesystem::path& path,
                     const std::vector<Obstacle<Dim>>& obstacles) {
    std::string text = "{\n\"pent_obstacles\": " + std::to_string(kVersion)
                       + ",\n\"dimension\": " + std::to_string(Dim) + ",\n\"obstacles\": [";
    for (const Obstacle<Dim>& obstacle : obstacles) {
        text += &obstacle == &obstacles.front() ? "\n" : ",\n";
        text += to_json<Dim>(obstacle).dump();
    }
    write_text(path, text + "\n]\n}\n");
}

template <int Dim>
std::vector<Obstacle<Dim>> read_obstacles(const std::filesystem::path& path) {
    const InputFile file = read_input(path);
    const Json json = Json::parse(file.view(), nullptr, false);
    const auto list = json.find("obstacles");
    if (count_of(json, "pent_obstacles") != kVersion || list == json.end() || !list->is_array()) {
        throw Error(path.string() + ": is not the list of a run's obstacles; expected JSON with"
                    " \"pent_obstacles\": " + std::to_string(kVersion) + " and \"obstacles\"");
    }
    if (count_of(json, "dimension") != Dim) {
        throw Error(path.string() + ": has no dimension or another; expected " + std::to_string(Dim)
                    + " as the bodies have");
    }
    std::vector<Obstacle<Dim>> obstacles;
    for (const Json& entry : *list) {
        const std::string where =
            path.string() + ": obstacle " + std::to_string(obstacles.size() + 1);
        obstacles.push_back(from_json<Dim>(entry, where));
    }
    return obstacles;
}

template std::string_view kind_of<3>(const Obstacle<3>&);
template std::string_view kind_of<4>(const Obstacle<4>&);
template void write_obstacles<3>(const std::filesystem::path&, const std::vector<Obstacle<3>>&);
template void write_obstacles<4>(const std::filesystem::path&, const std::vector<Obstacle<4>>&);
template std::vector<Obstacle<3>> read_obstacles<3>(const std::filesystem::path&);
template std::vector<Obstacle<4>> read_obstacles<4>(const std::filesystem::path&);

}  // namespace pent
