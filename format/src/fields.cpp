#include "body.h"

#include <pent/error.h>
#include <pent/printable.h>

#include <algorithm>
#include <array>
#include <utility>

namespace pent {

namespace {

constexpr std::array<std::string_view, 4> kFieldAxes = {"_x", "_y", "_z", "_w"};

// Whether a name can stand in a header: one word, short enough for a line.
bool is_word(const std::string& name) {
    constexpr std::size_t kLongest = kLongestLine - std::string_view("property double _x").size();
    return !name.empty() && name.size() <= kLongest
           && name.find_first_of(" \n") == std::string::npos && printable(name) == name;
}

}  // namespace

std::vector<Column> field_columns(const VertexField& field) {
    std::vector<Column> columns;
    for (Eigen::Index row = 0; row < field.values.rows(); ++row) {
        const std::string_view axis = field.values.rows() == 1 ? "" : kFieldAxes[row];
        // Encoding only reads through the pointer; decoding is given arrays that are not const.
        auto* data = const_cast<double*>(field.values.data());
        columns.push_back({field.name + std::string(axis), PlyType::Double,
                           reinterpret_cast<char*>(data == nullptr ? data : data + row),
                           static_cast<std::size_t>(field.values.rows()) * sizeof(double)});
    }
    return columns;
}

std::vector<VertexField> fields_of(const PlyElement& element,
                                   int dimension,
                                   const std::vector<std::string_view>& prefixes) {
    const std::vector<PlyProperty>& all = element.properties;
    const std::string_view axes =
        std::string_view("xyzw").substr(0, static_cast<std::size_t>(dimension));
    const auto is_known = [&](const std::string& name) {
        return std::any_of(prefixes.begin(), prefixes.end(), [&](std::string_view prefix) {
            return name.size() == prefix.size() + 1 && name.starts_with(prefix)
                   && axes.find(name.back()) != std::string_view::npos;
        });
    };
    std::vector<VertexField> fields;
    for (std::size_t i = 0; i < all.size();) {
        const std::string& name = all[i].name;
        if (all[i].type != PlyType::Double || all[i].count_type || is_known(name)) {
            ++i;
            continue;
        }
        const std::string stem = name.substr(0, std::max<std::size_t>(name.size(), 2) - 2);
        std::size_t found = 0;
        while (found < axes.size() && i + found < all.size()
               && all[i + found].type == PlyType::Double
               && all[i + found].name == stem + std::string(kFieldAxes[found])) {
            ++found;
        }
        const bool is_vector = found == axes.size() && !stem.empty();
        const auto count = static_cast<Eigen::Index>(element.count);
        fields.push_back(
            {is_vector ? stem : name, Eigen::MatrixXd(is_vector ? dimension : 1, count)});
        i += is_vector ? axes.size() : 1;
    }
    return fields;
}

void check_fields(const std::vector<VertexField>& fields,
                  int dimension,
                  Eigen::Index count,
                  std::string_view of,
                  const std::filesystem::path& path,
                  std::uint64_t first) {
    for (const VertexField& field : fields) {
        const Eigen::Index rows = field.values.rows();
        if ((rows != 1 && rows != dimension) || field.values.cols() != count) {
            throw Error(path.string() + ": " + field.name + " has " + std::to_string(rows) + " x "
                        + std::to_string(field.values.cols()) + " values, expected 1 or "
                        + std::to_string(dimension) + " x " + std::to_string(count));
        }
    }
    // Row by row, so that slabs of them, in order, find the same first fault.
    for (Eigen::Index i = 0; i < count; ++i) {
        for (const VertexField& field : fields) {
            if (!field.values.col(i).allFinite()) {
                throw Error(path.string() + ": " + std::string(of) + " "
                            + std::to_string(first + static_cast<std::uint64_t>(i)) + ": "
                            + field.name + " is not finite, expected finite numbers");
            }
        }
    }
}

std::set<std::string> axis_names(int dimension, const std::vector<std::string_view>& prefixes) {
    std::set<std::string> names;
    for (const std::string_view prefix : prefixes) {
        for (const char axis :
             std::string_view("xyzw").substr(0, static_cast<std::size_t>(dimension))) {
            names.insert(std::string(prefix) + axis);
        }
    }
    return names;
}

void check_names(const std::vector<VertexField>& fields,
                 int dimension,
                 const std::set<std::string>& reserved,
                 std::string_view of,
                 const std::filesystem::path& path) {
    const auto fail = [&](const std::string& name, const std::string& what) {
        throw Error(path.string() + ": " + std::string(of) + " quantity '" + printable(name)
                    + "': " + what);
    };
    std::set<std::string> seen;
    std::vector<Column> columns;
    for (const VertexField& field : fields) {
        if (!is_word(field.name)) {
            fail(field.name, "expected a name of letters, digits and '_'");
        }
        for (const Column& column : field_columns(field)) {
            if (reserved.contains(column.name)) {
                fail(field.name, "the property " + column.name
                                     + " has a meaning of its own, expected another name");
            }
            if (!seen.insert(column.name).second) {
                fail(field.name, "another quantity has the property " + column.name
                                     + " already, expected another name");
            }
            columns.push_back(column);
        }
    }
    const std::vector<VertexField> read = fields_of(make_element(of, 0, columns), dimension, {});
    for (std::size_t i = 0; i < fields.size(); ++i) {
        if (read[i].name != fields[i].name) {  // else there are as many
            fail(fields[i].name, "it and those behind it would be read as the vector "
                                     + read[i].name + ", expected other names");
        }
    }
}

}  // namespace pent
