#pragma once

#include <pent/simplex_mesh.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace pent::mesher {

/// A triangle surface in R^3, usually closed; seen from outside its triangles turn
/// counterclockwise.
struct Surface {
    Positions<3> points;     ///< 3 x points, m; no two at the same place, each used by a triangle.
    Simplices<3> triangles;  ///< 3 x triangles.

    [[nodiscard]] Eigen::Index point_count() const { return points.cols(); }
    [[nodiscard]] Eigen::Index triangle_count() const { return triangles.cols(); }
};

/// A surface as a file has it, and what was done to read it.
struct SurfaceFile {
    Surface surface;
    std::int64_t points_in_file = 0;
    std::int64_t merged_points = 0;  ///< Points at the place of an earlier one.
    std::int64_t unused_points = 0;  ///< Points without a triangle, left out.
    std::string left_out;            ///< Lines and points, as in "3 lines, 1 point".
};

/// Reads a surface from an OBJ, OFF, PLY, STL or glTF file, in double precision where the file has
/// it.
///
/// The ending of the name tells the format. Polygons are cut into triangles, points at the same
/// place become one, unused ones go. Nothing is checked beyond that: see check_surface().
/// Throws an Error that names file and line for what cannot be read, a point that is not finite, an
/// index out of range, or a file without a triangle.
[[nodiscard]] SurfaceFile read_surface(const std::filesystem::path& path);

/// Makes a surface of loose triangles: merges points at the same place, drops unused ones, keeps
/// the order of what is left. Triangles may come out with a corner twice; they are kept.
[[nodiscard]] SurfaceFile weld(const Positions<3>& points, const Simplices<3>& triangles);

/// Sum of the areas of the triangles, m^2.
[[nodiscard]] double area(const Surface& surface);

/// Volume enclosed by a closed surface, m^3: positive when it is oriented outward. Without a
/// meaning for an open one.
[[nodiscard]] double enclosed_volume(const Surface& surface);

/// Length of the diagonal of the bounding box, m.
[[nodiscard]] double diagonal(const Positions<3>& points);

}  // namespace pent::mesher
