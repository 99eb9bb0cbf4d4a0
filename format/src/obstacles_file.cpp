#include "pent/obstacles_file.h"

#include "input_file.h"

#include <pent/error.h>
#include <pent/output_file.h>

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace pent {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kVersion = 1;

// Writes the fields of a shape.
struct FieldWriter {
    Json& json;

    void operator()(const char* key, double value, ShapeField /*kind*/) const { json[key] = value; }
    template <int Size>
    void operator()(const char* key,
                    const Eigen::Matrix<double, Size, 1>& value,
                    ShapeField /*kind*/) const {
        json[key] = std::vector<double>(value.begin(), value.end());
    }
    // Left out where they are those of space, as they are of most.
    template <int Size>
    void operator()(const char* key,
                    const Eigen::Matrix<double, Size, Size>& axes,
                    ShapeField /*kind*/) const {
        if (!axes.isIdentity(0)) {
            for (const auto& axis : axes.colwise()) {
                json[key].push_back(std::vector<double>(axis.begin(), axis.end()));
            }
        }
    }
};

// Fills a vector; false if the list is of another length or has anything but finite numbers.
bool read_numbers(const Json& list, Eigen::Ref<Eigen::VectorXd> values) {
    if (!list.is_array() || list.size() != static_cast<std::size_t>(values.size())) {
        return false;
    }
    for (Eigen::Index i = 0; i < values.size(); ++i) {
        const Json& entry = list[static_cast<std::size_t>(i)];
        if (!entry.is_number()) {  // finite: none beyond a double's range is JSON here
            return false;
        }
        values[i] = entry.get<double>();
    }
    return true;
}

// Reads them.
struct FieldReader {
    const Json& json;
    const std::string& where;

    [[noreturn]] void fail(const char* key, const std::string& expected) const {
        throw Error(where + ": \"" + key + "\" is missing or out of range; expected " + expected);
    }
    void operator()(const char* key, double& value, ShapeField kind) const {
        const auto found = json.find(key);
        const bool is_number = found != json.end() && found->is_number();
        const bool is_length = kind == ShapeField::Length;
        if (!is_number || (is_length && !(found->get<double>() > 0))) {
            fail(key, is_length ? "a number above 0" : "a finite number");
        }
        value = found->get<double>();
    }
    void operator()(const char* key, Eigen::VectorXd& value, ShapeField kind) const {
        const std::string count = std::to_string(value.size());
        const auto found = json.find(key);
        if (found == json.end() || !read_numbers(*found, value)) {
            fail(key, count + " finite numbers");
        }
        const bool is_direction = kind == ShapeField::Direction || kind == ShapeField::UpDirection;
        if (is_direction && !(std::abs(value.stableNorm() - 1) <= 1e-9)) {
            fail(key, count + " numbers, of length 1 together");
        }
        if (kind == ShapeField::Length && !(value.array() > 0).all()) {
            fail(key, count + " numbers above 0");
        }
    }
    void operator()(const char* key, Eigen::MatrixXd& axes, ShapeField /*kind*/) const {
        const auto found = json.find(key);
        if (found == json.end()) {
            return;
        }
        bool is_right = found->is_array() && found->size() == static_cast<std::size_t>(axes.cols());
        for (Eigen::Index i = 0; is_right && i < axes.cols(); ++i) {
            is_right = read_numbers((*found)[static_cast<std::size_t>(i)], axes.col(i));
        }
        if (!is_right || !is_rotation(axes)) {
            fail(key, std::to_string(axes.cols()) + " vectors of length 1 across one another");
        }
    }
};

// In quotes and on one line, whatever it is.
std::string quoted(const std::string& text) {
    return Json(text).dump(-1, ' ', true, Json::error_handler_t::replace);
}

std::string known_kinds() {
    std::string text;
    const std::vector<ObstacleShape<Eigen::Dynamic>> shapes = all_shapes(4);
    for (const ObstacleShape<Eigen::Dynamic>& shape : shapes) {
        text += &shape == &shapes.front() ? "" : &shape == &shapes.back() ? " or " : ", ";
        text += name_of<Eigen::Dynamic>(shape);
    }
    return text;
}

ObstacleShape<Eigen::Dynamic> shape_of_kind(const std::string& kind,
                                            int dimension,
                                            const std::string& where) {
    for (const ObstacleShape<Eigen::Dynamic>& shape : all_shapes(dimension)) {
        if (kind == name_of<Eigen::Dynamic>(shape)) {
            return shape;
        }
    }
    throw Error(where + ": found an obstacle of kind " + quoted(kind) + "; expected "
                + known_kinds() + "; a newer pent-sim may have made it");
}

template <int Dim>
Json to_json(const ObstacleShape<Dim>& obstacle) {
    Json json;
    json["kind"] = name_of<Dim>(obstacle);
    std::visit([&](const auto& shape) { shape.fields(shape, FieldWriter{json}); }, obstacle);
    return json;
}

template <int Dim>
ObstacleShape<Dim> from_json(const Json& json, const std::string& where) {
    const auto kind = json.find("kind");
    if (kind == json.end() || !kind->is_string()) {
        throw Error(where + ": found no kind; expected " + known_kinds());
    }
    auto obstacle = shape_of_kind(kind->get<std::string>(), Dim, where);
    std::visit([&](auto& shape) { shape.fields(shape, FieldReader{json, where}); }, obstacle);
    // A key more may say that it moves: drawn at rest it would be in the wrong place.
    std::set<std::string> known = {"kind"};
    std::visit(
        [&](auto& shape) {
            shape.fields(shape, [&](const char* name, const auto& /*value*/, ShapeField /*kind*/) {
                known.insert(name);
            });
        },
        obstacle);
    for (const auto& [key, value] : json.items()) {
        if (!known.contains(key)) {
            throw Error(where + ": found the key " + quoted(key)
                        + ", which is not known; a newer pent-sim may have made it");
        }
    }
    return fixed_size<Dim>(obstacle);
}

// A key of the file's own; `value` is 0 where there is none or another kind of thing.
std::uint64_t count_of(const Json& json, const char* key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
}

}  // namespace

template <int Dim>
std::string obstacles_text(const std::vector<ObstacleShape<Dim>>& obstacles) {
    std::string text = "{\n\"pent_obstacles\": " + std::to_string(kVersion)
                       + ",\n\"dimension\": " + std::to_string(Dim) + ",\n\"obstacles\": [";
    for (const ObstacleShape<Dim>& obstacle : obstacles) {
        text += &obstacle == &obstacles.front() ? "\n" : ",\n";
        text += to_json<Dim>(obstacle).dump();
    }
    return text + "\n]\n}\n";
}

template <int Dim>
void write_obstacles(const std::filesystem::path& path,
                     const std::vector<ObstacleShape<Dim>>& obstacles) {
    write_text(path, obstacles_text<Dim>(obstacles));
}

template <int Dim>
std::vector<ObstacleShape<Dim>> read_obstacles(const std::filesystem::path& path) {
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
    std::vector<ObstacleShape<Dim>> obstacles;
    for (const Json& entry : *list) {
        const std::string where =
            path.string() + ": obstacle " + std::to_string(obstacles.size() + 1);
        obstacles.push_back(from_json<Dim>(entry, where));
    }
    return obstacles;
}

template std::string obstacles_text<3>(const std::vector<ObstacleShape<3>>&);
template std::string obstacles_text<4>(const std::vector<ObstacleShape<4>>&);
template void write_obstacles<3>(const std::filesystem::path&,
                                 const std::vector<ObstacleShape<3>>&);
template void write_obstacles<4>(const std::filesystem::path&,
                                 const std::vector<ObstacleShape<4>>&);
template std::vector<ObstacleShape<3>> read_obstacles<3>(const std::filesystem::path&);
template std::vector<ObstacleShape<4>> read_obstacles<4>(const std::filesystem::path&);

}  // namespace pent
