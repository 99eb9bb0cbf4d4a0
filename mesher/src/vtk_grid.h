#pragma once

#include "cells.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pent::mesher {

/// An array of the points or cells of a grid, one tuple after the other.
struct VtkArray {
    std::string name;
    std::int64_t components = 1;
    std::vector<double> values;
};

/// An unstructured grid of VTK.
struct VtkGrid {
    CellSoup soup;
    std::int64_t cell_count = 0;            ///< In the file, of all dimensions.
    std::vector<std::int64_t> solid_cells;  ///< Which cell of the file each of the soup's is.
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::int64_t> triangle_cells;  ///< Which cell of the file each triangle is.
    std::vector<VtkArray> point_arrays;
    std::vector<VtkArray> cell_arrays;
};

/// Says what is wrong with the place in front, by an exception.
using Fail = std::function<void(const std::string& message)>;

/// Adds a cell by VTK's number for its type. The points are there already.
void add_cell(VtkGrid& grid,
              std::int64_t type,
              std::span<const std::int64_t> corners,
              const Fail& fail);

/// The array with a name; null if there is none.
[[nodiscard]] const VtkArray* find_array(const std::vector<VtkArray>& arrays,
                                         std::string_view name);

/// The label of a cell of the file: a whole number from 0 to 65535, else nothing.
[[nodiscard]] std::optional<std::uint16_t> label_of(const VtkArray& array, std::int64_t cell);

/// The array with the labels of the cells: the one asked for, else the first with a usual name,
/// in whatever case, and a label of every cell of three dimensions; null if there is none.
/// Throws an Error if that asked for is not there or has other numbers than labels.
[[nodiscard]] const VtkArray* region_array(const VtkGrid& grid,
                                           const std::string& asked,
                                           const std::filesystem::path& path);

/// Gives the cells of the soup the labels that region_array() found.
void label_cells(VtkGrid& grid, const VtkArray& regions);

/// Reads an unstructured grid with its arrays of numbers, of a legacy file (.vtk) or an XML file
/// (.vtu).
///
/// Throws an Error that names the file and the place for what is damaged, and for points that are
/// not finite; allocates no more than the size of the file bears out.
[[nodiscard]] VtkGrid read_vtk_grid(const std::filesystem::path& path);
[[nodiscard]] VtkGrid read_vtu_grid(const std::filesystem::path& path);

/// The same by the format, as in "vtu", or by the ending of the name where there is none.
[[nodiscard]] VtkGrid read_grid(const std::filesystem::path& path, const std::string& format = {});

}  // namespace pent::mesher
