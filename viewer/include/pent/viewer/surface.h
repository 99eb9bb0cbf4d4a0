#pragma once

#include <pent/simplex_mesh.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>
#include <vector>

namespace pent::viewer {

/// Triangles in R^3; they turn counter-clockwise when seen from outside.
struct TriangleMesh {
    Positions<3> positions;  ///< 3 x vertices, m.
    Simplices<3> triangles;  ///< 3 x triangles.

    [[nodiscard]] Eigen::Index vertex_count() const { return positions.cols(); }
    [[nodiscard]] Eigen::Index triangle_count() const { return triangles.cols(); }
};

/// A closed triangle surface that remembers the body it was taken from.
///
/// Vertex v lies on the mesh edge from ends(0, v) to ends(1, v), ends(0, v) <= ends(1, v), at
/// (1 - weights[v]) of the first and weights[v] of the second; a vertex of the mesh itself has
/// equal ends or weight 0 or 1.
struct Surface : TriangleMesh {
    Simplices<2> ends;                  ///< 2 x vertices: vertices of the mesh.
    Eigen::VectorXd weights;            ///< One a vertex, 0..1.
    std::vector<std::uint32_t> facets;  ///< One a triangle: the boundary facet it lies in.
};

/// Values at the vertices of a mesh, carried to the vertices of a surface taken from it.
[[nodiscard]] Eigen::VectorXd interpolate(const Surface& surface, const Eigen::VectorXd& values);

/// Volume inside a closed surface, m^3; negative if it is inside out.
[[nodiscard]] double enclosed_volume(const TriangleMesh& surface);

/// Area of all triangles, m^2.
[[nodiscard]] double area(const TriangleMesh& surface);

/// The smallest box around all vertices; empty for a surface without any.
[[nodiscard]] Eigen::AlignedBox3d bounding_box(const TriangleMesh& surface);

/// Merges surface vertices that lie on the same vertex of the mesh and drops the triangles that
/// collapse with it, so that a plane through vertices leaves no triangles of zero area.
///
/// The result is as closed and oriented as the input. Where merging would put more than two
/// triangles at an edge (the plane pinches the body there), the vertices of that edge stay apart,
/// so every edge keeps exactly two triangles.
[[nodiscard]] Surface merge_coincident(const Surface& surface);

}  // namespace pent::viewer
