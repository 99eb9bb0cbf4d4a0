#include "carried_arrays.h"

#include "spacetime/moving_fields.h"

#include <pent/formatted.h>
#include <pent/pent_file.h>

#include <algorithm>
#include <limits>
#include <optional>

namespace pent::mesher {

namespace {

// Whether an array becomes a quantity; if not, `left_out` gets the reason.
bool can_carry(const FileArray& array,
               const std::vector<std::string>& carried,
               std::vector<std::string>& left_out) {
    const bool has_room = array.components == 1 || array.components == 3;
    const bool is_new = std::find(carried.begin(), carried.end(), array.name) == carried.end();
    if (!has_room || !is_new) {
        left_out.push_back(
            "array " + array.name
            + (has_room ? ", a second one"
                        : formatted(" of %d components", static_cast<int>(array.components))));
    }
    return has_room && is_new;
}

// Which tuple of an array a point or cell has, if it has one.
std::optional<std::int64_t> tuple_of(const FileArray& array, std::int64_t number) {
    if (!array.numbers) {
        return number;
    }
    const std::vector<std::int64_t>& numbers = *array.numbers;
    const auto found = std::lower_bound(numbers.begin(), numbers.end(), number);
    return found != numbers.end() && *found == number ? std::optional(found - numbers.begin())
                                                      : std::nullopt;
}

}  // namespace

const FileArray* find_array(const std::vector<FileArray>& arrays, std::string_view name) {
    for (const FileArray& array : arrays) {
        if (array.name == name) {
            return &array;
        }
    }
    return nullptr;
}

CarriedArrays carried_point_arrays(const FileGrid& grid, std::vector<std::string>& left_out) {
    FieldNames names(reserved_vertex_names(4));
    CarriedArrays carried;
    for (const FileArray& array : grid.point_arrays) {
        if (can_carry(array, carried.arrays, left_out)) {
            carried.arrays.push_back(array.name);
            carried.names.push_back(names.take(array.name, array.components == 3));
        }
    }
    return carried;
}

CarriedArrays carried_cell_arrays(const FileGrid& grid,
                                  const CarriedArrays& of_points,
                                  std::string_view regions,
                                  std::vector<std::string>& left_out) {
    FieldNames names(reserved_cell_names(4), {of_points.names.begin(), of_points.names.end()});
    CarriedArrays carried;
    bool has_fibers = false;
    for (const FileArray& array : grid.cell_arrays) {
        if (array.name == regions || !can_carry(array, carried.arrays, left_out)) {
            continue;
        }
        const bool is_vector = array.components == 3;
        const bool is_fiber = !has_fibers && is_vector && is_fiber_name(array.name);
        has_fibers = has_fibers || is_fiber;
        carried.arrays.push_back(array.name);
        carried.names.push_back(is_fiber ? array.name : names.take(array.name, is_vector));
    }
    return carried;
}

Eigen::MatrixXd values_at(const FileArray& array, const std::vector<std::int64_t>& numbers) {
    Eigen::MatrixXd values(array.components, static_cast<Eigen::Index>(numbers.size()));
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const std::optional<std::int64_t> tuple = tuple_of(array, numbers[i]);
        for (std::int64_t k = 0; k < array.components; ++k) {
            values(k, static_cast<Eigen::Index>(i)) =
                tuple ? array.values[static_cast<std::size_t>(*tuple * array.components + k)]
                      : std::numeric_limits<double>::quiet_NaN();
        }
    }
    return values;
}

}  // namespace pent::mesher
