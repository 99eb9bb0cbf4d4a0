#pragma once

#include <pent/simplex_mesh.h>

#include <cstdint>
#include <string_view>
#include <vector>

namespace pent::exchange {

/// A hypersurface of tetrahedra in R^4, as the boundary of a body is: what other programs of four
/// dimensions call a mesh.
struct TetSurface {
    Positions<4> points;      ///< 4 x n, m.
    Simplices<4> tetrahedra;  ///< 4 x tetrahedra, each outward as FacetMatch<4>::boundary has it.
};

/// A surface and what became of its points.
struct WeldedSurface {
    TetSurface surface;
    std::int64_t merged_points = 0;  ///< At the same place as an earlier one.
    std::int64_t degenerate = 0;     ///< Tetrahedra with a corner twice, left out.
};

/// Makes points at the same place one, the first of them; leaves out tetrahedra that have a corner
/// twice then, and points that no tetrahedron has. The order stays.
[[nodiscard]] WeldedSurface weld(const TetSurface& surface);

/// Leaves out points that no tetrahedron has. The order stays.
[[nodiscard]] TetSurface without_unused_points(const TetSurface& surface);

/// How tetrahedra meet at their triangles.
struct SurfaceCheck {
    std::int64_t open = 0;       ///< Triangles of one tetrahedron.
    std::int64_t overfull = 0;   ///< Triangles of more than two.
    std::int64_t one_sided = 0;  ///< Triangles of two that see it from the same side.

    [[nodiscard]] bool is_closed() const { return open == 0 && overfull == 0; }
    [[nodiscard]] bool is_oriented() const { return is_closed() && one_sided == 0; }
};

[[nodiscard]] SurfaceCheck check(const TetSurface& surface);

/// The hypervolume that an oriented closed surface encloses, m^4; negative if it is inside out.
[[nodiscard]] double enclosed_hypervolume(const TetSurface& surface);

/// Turns tetrahedra over until they face outward: where neighbors agree all of them or none, else
/// piece by piece, each of which is then taken for the outside of something. Surfaces that are not
/// closed are left as they are.
///
/// Throws an Error that begins with `name` if a piece has one side only.
void orient(TetSurface& surface, std::string_view name);

/// The boundary of a mesh, with the vertices that it uses, in their order.
[[nodiscard]] TetSurface boundary_of(const SimplexMesh<4>& mesh);

/// The same, with the vertex of the mesh that each of its points is.
struct BodyBoundary {
    TetSurface surface;
    std::vector<std::uint32_t> vertices;  ///< One a point, ascending.
};
[[nodiscard]] BodyBoundary boundary_with_vertices(const SimplexMesh<4>& mesh);

/// The body inside a closed surface that some point sees all of, as it sees that of anything
/// convex: pentachora from that point to each tetrahedron. The boundary is the surface, exactly.
///
/// @param surface  Without unused points, which the body would have, too.
/// Throws an Error that begins with `name` if the surface is not closed or no such point is found.
[[nodiscard]] SimplexMesh<4> cone_of(const TetSurface& surface, std::string_view name);

}  // namespace pent::exchange
