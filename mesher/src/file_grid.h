#pragma once

#include "cells.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pent::mesher {

/// An array of the points or cells of a file, one tuple after the other.
struct FileArray {
    std::string name;
    std::int64_t components = 1;
    std::vector<double> values;
    /// The point or cell of each tuple, by its number in the file, ascending; nothing: all of them
    /// in their order, from 0.
    std::optional<std::vector<std::int64_t>> numbers = {};
};

/// Points and cells of a file, and what it has of them.
struct FileGrid {
    CellSoup soup;
    std::vector<std::int64_t> point_numbers;  ///< Of the soup's points; empty: from 0.
    std::int64_t cell_count = 0;              ///< In the file, of all dimensions.
    std::vector<std::int64_t> solid_cells;    ///< Numbers of the soup's cells; empty: from 0.
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Of VTK.
    std::vector<std::int64_t> triangle_cells;             ///< Their numbers.
    std::vector<FileArray> point_arrays;
    std::vector<FileArray> cell_arrays;
    std::vector<std::string> left_out;  ///< What is in no array, as in "array T, a second one".
};

/// The array with a name; null if there is none.
[[nodiscard]] const FileArray* find_array(const std::vector<FileArray>& arrays,
                                          std::string_view name);

}  // namespace pent::mesher
