#pragma once

#include <pent/simplex_mesh.h>

#include <filesystem>

namespace pent::mesher {

/// Points and triangles as a file lists them, polygons already cut.
struct TriangleSoup {
    Positions<3> points;     ///< 3 x n, finite.
    Simplices<3> triangles;  ///< Indices in range.
};

/// Reads `v` and `f` lines of a Wavefront OBJ file in double precision; all else is skipped.
[[nodiscard]] TriangleSoup read_obj(const std::filesystem::path& path);

/// Reads every triangle of a file through assimp, in float, with the placements of its scene.
[[nodiscard]] TriangleSoup read_with_assimp(const std::filesystem::path& path);

}  // namespace pent::mesher
