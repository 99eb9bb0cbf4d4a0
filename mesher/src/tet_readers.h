#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace pent::mesher {

/// Points and tetrahedra as a file lists them; corners are indices of points.
struct TetSoup {
    std::vector<Eigen::Vector3d> points;
    std::vector<std::array<std::uint32_t, 4>> tets;
    std::vector<std::int64_t> labels;  ///< One a tetrahedron, or empty.
};

[[nodiscard]] TetSoup read_tetgen(const std::filesystem::path& path);
[[nodiscard]] TetSoup read_medit(const std::filesystem::path& path);
[[nodiscard]] TetSoup read_gmsh(const std::filesystem::path& path);
[[nodiscard]] TetSoup read_vtk(const std::filesystem::path& path);
[[nodiscard]] TetSoup read_tobj(const std::filesystem::path& path);

}  // namespace pent::mesher
