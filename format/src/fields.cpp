#include "body.h"

#include <pent/error.h>

#include <algorithm>
#include <array>
#include <utility>

namespace pent {

namespace {

constexpr std::array<std::string_view, 4> kFieldAxes = {"_x", "_y", "_z", "_w"};

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
        for (Eigen::Index i = 0; i < count; ++i) {
            if (!field.values.col(i).allFinite()) {
                throw Error(path.string() + ": " + std::string(of) + " "
                            + std::to_string(first + static_cast<std::uint64_t>(i)) + ": "
                            + field.name + " is not finite, expected finite numbers");
            }
        }
    }
}

}  // namespace pent
