#include "moving_fields.h"

#include <algorithm>
#include <array>
#include <utility>

namespace pent::mesher {

namespace {

constexpr std::array<std::string_view, 4> kAxes = {"_x", "_y", "_z", "_w"};

std::vector<std::string> properties_of(const std::string& name, bool is_vector) {
    if (!is_vector) {
        return {name};
    }
    std::vector<std::string> properties;
    for (const std::string_view axis : kAxes) {
        properties.push_back(name + std::string(axis));
    }
    return properties;
}

}  // namespace

bool FieldNames::is_free(const std::string& name, bool is_vector) const {
    const auto is_taken = [&](const std::string& property) { return taken_.contains(property); };
    const std::vector<std::string> properties = properties_of(name, is_vector);
    if (std::any_of(properties.begin(), properties.end(), is_taken)) {
        return false;
    }
    if (is_vector || !name.ends_with(kAxes.back())) {
        return true;
    }
    // Numbers u_x, u_y, u_z and u_w would be read as a vector.
    const std::vector<std::string> vector = properties_of(name.substr(0, name.size() - 2), true);
    return !std::all_of(vector.begin(), vector.end() - 1, is_taken);
}

std::string FieldNames::take(std::string_view name, bool is_vector) {
    std::string result;
    for (const char c : name) {
        const bool is_plain =
            (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
        result += is_plain ? c : '_';
    }
    while (result.empty() || others_.contains(result) || !is_free(result, is_vector)) {
        result += '_';
    }
    for (const std::string& property : properties_of(result, is_vector)) {
        taken_.insert(property);
    }
    return result;
}

bool is_fiber_name(std::string_view name) {
    return name == "fiber" || name == "fibers";
}

void add_values(Eigen::MatrixXd values, MovingField& field) {
    if (field.values.empty() || field.values.front().rows() == values.rows()) {
        field.values.push_back(std::move(values));
    }
}

std::vector<std::string> remove_unfinished(std::vector<MovingField>& fields,
                                           std::size_t frames,
                                           const std::string& kind) {
    std::vector<std::string> removed;
    std::erase_if(fields, [&](const MovingField& field) {
        const bool is_unfinished = field.values.size() != frames;
        if (is_unfinished) {
            removed.push_back(kind + " " + field.name
                              + ", which some frames do not have in finite numbers");
        }
        return is_unfinished;
    });
    return removed;
}

}  // namespace pent::mesher
