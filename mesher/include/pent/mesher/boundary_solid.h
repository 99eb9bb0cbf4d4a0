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
    std::int64_t repeated = 0;       ///< Duplicates of earlier tetrahedra: of each set one is kept,
                                     ///< or none where they face each other.
    std::int64_t turned = 0;         ///< Tetrahedra turned over to face as their neighbors do.
    std::int64_t open = 0;           ///< Triangles that more tetrahedra see from one side than from
                                     ///< the other.
    std::int64_t holes = 0;          ///< Closed by a cone over the triangles around them.
    double largest_hole = 0;         ///< Volume of the cone that closes the largest one, m^3.
    Eigen::Vector4d hole_place = Eigen::Vector4d::Zero();  ///< The tip of that cone, m.
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

/// The body within a closed hypersurface of tetrahedra: all points whose winding number is not
/// zero. Its function is the signed distance to the hypersurface; the sign is decided exactly, by
/// the tetrahedra that a ray from the point crosses.
///
/// A hypersurface that is not closed is closed first: holes get cones from their middles over the
/// triangles around them, after which every ray from a point crosses it equally often. Its pieces
/// are the patches between triangles at which tetrahedra meet at more than 40 degrees; the function
/// of each is the height over the nearest tetrahedron of it.
///
/// @param surface   Any; tetrahedra of finite points.
/// @param may_mend  If not, one that is not closed and embedded is refused.
/// Throws an Error that begins with `name` for one that has faults and may not be mended (which,
/// how many and where), that encloses nothing, that has a hole of more than a quarter of its
/// volume, or that is not within 1e-30 to 1e30 m across.
[[nodiscard]] BoundarySolid boundary_solid(const exchange::TetSurface& surface,
                                           const std::string& name,
                                           bool may_mend = true);

/// Whether pent::exchange reads a file as one of four dimensions: by the ending of its name; where
/// surfaces of three dimensions have the same ending, as .off and .obj, by its first lines.
[[nodiscard]] bool is_boundary_file(const std::filesystem::path& path);

/// The boundary in a file of any format of pent::exchange; that of its body if it holds one.
[[nodiscard]] exchange::TetSurface read_boundary(const std::filesystem::path& path);

}  // namespace pent::mesher
