#pragma once

#include "cells.h"
#include "file_grid.h"

#include <pent/mesher/read_tetrahedra.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace pent::mesher {

/// Tetrahedra with the points that they use, and where both come from.
struct NumberedTetrahedra {
    TetrahedraFile file;
    std::vector<std::uint32_t> points;  ///< Which of the soup's each vertex is.
    std::vector<std::uint32_t> cells;   ///< Which of the soup's each tetrahedron comes from.
};

/// Cuts the cells of a file, leaves out points without a tetrahedron, and validates the mesh.
/// Throws an Error that begins with `name` where that is not possible.
[[nodiscard]] NumberedTetrahedra number_tetrahedra(const CellSoup& soup, const std::string& name);

/// Readers of one format each. Every one throws an Error that names file and line (or byte) for
/// what is damaged, and allocates no more than the size of the file bears out.

[[nodiscard]] FileGrid read_tetgen(const std::filesystem::path& path);
[[nodiscard]] FileGrid read_medit(const std::filesystem::path& path);
[[nodiscard]] FileGrid read_gmsh(const std::filesystem::path& path);
[[nodiscard]] CellSoup read_tobj(const std::filesystem::path& path);

}  // namespace pent::mesher
