#pragma once

#include <pent/exchange/tet_surface.h>
#include <pent/mesher/solid.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace pent::mesher {

/// What was found of a boundary of tetrahedra, and what was done to it.
struct BoundaryReport {
    std::int64_t tetrahedra = 0;     ///< As read.
    std::int64_t merged_points = 0;  ///< Points at the same place as another one.
    std::int64_t degenerate = 0;     ///< Tetrahedra with a corner twice: left out.
    std::int64_t repeated = 0;       ///< More than one on the same corners: one of them, or none
                                     ///< where they face each other.
    std::int64_t turned = 0;         ///< Tetrahedra turned over to face as their neighbors do.
    std::int64_t open = 0;           ///< Triangles with more on one side than on the other.
    std::int64_t holes = 0;          ///< Closed by a cone over the triangles around them.
    double largest_hole = 0;         ///< What closes it, m^3.
    Eigen::Vector4d hole_place = Eigen::Vector4d::Zero();  ///< The middle of the largest one, m.
    std::int64_t inner = 0;    ///< Tetrahedra with the body, or none of it, on both sides.
    std::int64_t patches = 0;  ///< Smooth parts that meet at ridges.

    /// Whether something was mended that a sound file does not have.
    [[nodiscard]] bool is_mended() const {
        return repeated + turned + open + holes + degenerate + inner > 0;
    }
};

/// What was mended in words, on one line.
[[nodiscard]] std::string describe(const BoundaryReport& report);

struct BoundarySolid {
    Solid solid;
    BoundaryReport report;
};

/// The body within a closed hypersurface of tetrahedra: all points that it winds around, either
/// way. The function is the distance to the nearest point of the hypersurface; which side a point
/// is on is decided exactly, by the tetrahedra that a ray from it crosses.
///
/// A hypersurface that is not closed is closed first: holes get cones from their middles over the
/// triangles around them, after which every ray from a point crosses it equally often. Its pieces
/// are the patches between triangles at which tetrahedra meet at more than 40 degrees; the function
/// of each is the height over the nearest tetrahedron of it.
///
/// @param surface   Any; tetrahedra of finite points.
/// @param may_mend  If not, one that is not closed and embedded is refused.
/// Throws an Error that begins with `name` for one that may not be mended, that encloses nothing,
/// with a hole of a quarter of it, with what, how many and where, or that is not within 1e-30 to
/// 1e30 m across.
[[nodiscard]] BoundarySolid boundary_solid(const exchange::TetSurface& surface,
                                           const std::string& name,
                                           bool may_mend = true);

/// Whether a file is one that pent::exchange reads and that is no surface or tet mesh of three
/// dimensions: by its ending, and that of .off and .obj files by how they begin.
[[nodiscard]] bool is_boundary_file(const std::filesystem::path& path);

/// The boundary in a file of any format of pent::exchange; that of its body if it holds one.
[[nodiscard]] exchange::TetSurface read_boundary(const std::filesystem::path& path);

}  // namespace pent::mesher
