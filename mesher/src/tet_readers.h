#pragma once

#include "cells.h"

#include <filesystem>

namespace pent::mesher {

/// Readers of one format each. Every one throws an Error that names file and line (or byte) for
/// what is damaged, and allocates no more than the size of the file bears out.

[[nodiscard]] CellSoup read_tetgen(const std::filesystem::path& path);
[[nodiscard]] CellSoup read_medit(const std::filesystem::path& path);
[[nodiscard]] CellSoup read_gmsh(const std::filesystem::path& path);
[[nodiscard]] CellSoup read_vtk(const std::filesystem::path& path);
[[nodiscard]] CellSoup read_tobj(const std::filesystem::path& path);

}  // namespace pent::mesher
