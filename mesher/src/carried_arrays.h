#pragma once

#include "file_grid.h"

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pent::mesher {

/// Arrays of a grid that become quantities of a body.
struct CarriedArrays {
    std::vector<std::string> arrays;
    std::vector<std::string> names;  ///< What each is called there; fibers keep their name.
};

/// The arrays with one or three components; `left_out` gets a phrase for each of the others.
[[nodiscard]] CarriedArrays carried_point_arrays(const FileGrid& grid,
                                                 std::vector<std::string>& left_out);

/// The same of the cells, under names that none of the points has.
/// @param of_points  Those of the points.
/// @param regions    The array with their labels, which is none of them.
[[nodiscard]] CarriedArrays carried_cell_arrays(const FileGrid& grid,
                                                const CarriedArrays& of_points,
                                                std::string_view regions,
                                                std::vector<std::string>& left_out);

/// The values of an array at some points or cells, a column each; NaN where it has none.
/// @param numbers  By which the file knows these points or cells.
[[nodiscard]] Eigen::MatrixXd values_at(const FileArray& array,
                                        const std::vector<std::int64_t>& numbers);

}  // namespace pent::mesher
