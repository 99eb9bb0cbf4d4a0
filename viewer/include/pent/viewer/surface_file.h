#pragma once

#include <pent/viewer/color.h>
#include <pent/viewer/surface.h>

#include <Eigen/Core>

#include <filesystem>
#include <string>
#include <vector>

namespace pent::viewer {

enum class SurfaceFormat { Ply, Obj, Vtu };

/// A number at every vertex of a surface, for programs that can show it.
struct VertexScalar {
    std::string name;        ///< A word.
    Eigen::VectorXd values;  ///< One a vertex.
};

/// What goes into a surface file besides the triangles.
struct SurfaceExtras {
    std::vector<VertexScalar> scalars;  ///< PLY and VTU only.
    Eigen::Matrix3Xf colors;  ///< 3 x vertices, linear light, or 3 x 0 for none; not in VTU.
    std::string comment;      ///< One line; empty for none.
};

/// ".ply", ".obj" or ".vtu".
[[nodiscard]] std::string extension(SurfaceFormat format);

/// Writes a surface through an OutputFile; throws an Error as that does. A surface without
/// triangles gives a valid file without any.
///
/// PLY is binary, little-endian, with double positions, float scalars and 8-bit sRGB colors
/// (`red green blue`). OBJ has positions that read back exactly, with sRGB colors 0..1 behind them.
/// VTU is an unstructured grid of triangles with raw appended data.
void write_surface(const std::filesystem::path& path,
                   const TriangleMesh& surface,
                   SurfaceFormat format,
                   const SurfaceExtras& extras = {});

}  // namespace pent::viewer
