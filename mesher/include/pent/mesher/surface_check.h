#pragma once

#include <pent/mesher/surface.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace pent::mesher {

/// One kind of fault of a surface: how many, and where the first one is.
struct Defect {
    std::int64_t count = 0;
    std::int64_t first_triangle = -1;                 ///< The lowest triangle at fault.
    Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< Its first corner, m.
};

/// What keeps a surface from being the boundary of a body. All counts are exact.
struct SurfaceReport {
    std::int64_t points = 0;
    std::int64_t triangles = 0;
    std::int64_t components = 0;  ///< Parts connected through edges.

    Defect degenerate;           ///< Triangles without area: a corner twice, or corners on a line.
    Defect duplicate;            ///< Triangles with the corners of an earlier one.
    Defect border_edges;         ///< Edges of one triangle only.
    Defect non_manifold_edges;   ///< Edges of more than two triangles.
    Defect non_manifold_points;  ///< Points at which several fans of triangles meet.
    Defect misoriented_edges;    ///< Edges whose two triangles turn against each other.
    Defect self_intersections;   ///< Pairs of triangles that touch beyond their shared corners.

    /// Closed, manifold and free of self-intersections: it bounds a body once it is oriented.
    [[nodiscard]] bool is_clean() const;
};

/// Looks for everything in SurfaceReport; corners and coordinates are taken as exact.
[[nodiscard]] SurfaceReport check_surface(const Surface& surface);

/// Pairs of triangles that meet in more than their shared corners or edge, lower one first, sorted.
///
/// Touching counts. Degenerate triangles and pairs with the same three corners are left out: they
/// are defects of their own. Exact [cgal2022].
[[nodiscard]] std::vector<std::array<std::uint32_t, 2>> self_intersections(const Surface& surface);

/// The defects in one line, as in "3 border edges (first at triangle 10, near (0, 0.5, 1))"; a
/// clean surface gives "closed, manifold, free of self-intersections".
[[nodiscard]] std::string describe(const SurfaceReport& report);

}  // namespace pent::mesher
