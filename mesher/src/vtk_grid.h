#pragma once

#include "file_grid.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace pent::mesher {

/// Says what is wrong with the place in front, by an exception.
using Fail = std::function<void(const std::string& message)>;

/// Adds a cell by VTK's number for its type. The points are there already.
void add_cell(FileGrid& grid,
              std::int64_t type,
              std::span<const std::int64_t> corners,
              const Fail& fail);

/// The label of a cell of the file: a whole number from 0 to 65535, else nothing.
[[nodiscard]] std::optional<std::uint16_t> label_of(const FileArray& array, std::int64_t cell);

/// The array with the labels of the cells: the one asked for, else the first with a usual name,
/// in whatever case, and a label of every cell of three dimensions; null if there is none.
/// Throws an Error if that asked for is not there or has other numbers than labels.
[[nodiscard]] const FileArray* region_array(const FileGrid& grid,
                                            const std::string& asked,
                                            const std::filesystem::path& path);

/// Gives the cells of the soup the labels that region_array() found.
void label_cells(FileGrid& grid, const FileArray& regions);

/// Reads an unstructured grid of VTK with its arrays of numbers, of a legacy file (.vtk) or an XML
/// file (.vtu).
///
/// Throws an Error that names the file and the place for what is damaged, and for points that are
/// not finite; allocates no more than the size of the file bears out.
[[nodiscard]] FileGrid read_vtk_grid(const std::filesystem::path& path);
[[nodiscard]] FileGrid read_vtu_grid(const std::filesystem::path& path);

/// The same by the format, as in "vtu", or by the ending of the name where there is none.
[[nodiscard]] FileGrid read_grid(const std::filesystem::path& path, const std::string& format = {});

}  // namespace pent::mesher
