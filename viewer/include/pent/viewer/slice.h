#pragma once

#include <pent/simplex_mesh.h>
#include <pent/viewer/boundary.h>
#include <pent/viewer/hyperplane.h>
#include <pent/viewer/surface.h>

namespace pent::viewer {

/// The slice of a four-dimensional body by a hyperplane: a closed, outward oriented surface in the
/// 3D frame of the hyperplane. Empty if the hyperplane misses the body.
///
/// A vertex exactly on the hyperplane counts as above it. With that one rule every boundary edge is
/// cut or not, alike for all its tetrahedra, so every edge of the slice has exactly two triangles,
/// with opposite directions, also for hyperplanes through vertices, edges and whole cells; there
/// the surface has triangles of zero area (see merge_coincident). An edge point is computed once,
/// from the lower vertex. The order of vertices and triangles does not depend on threads.
///
/// @param positions  Of the vertices of the mesh; they need not be those the boundary came from.
[[nodiscard]] Surface slice(const Boundary<4>& boundary,
                            const Positions<4>& positions,
                            const FramedHyperplane& hyperplane);

/// The whole boundary surface of a three-dimensional body.
[[nodiscard]] Surface skin(const Boundary<3>& boundary, const Positions<3>& positions);

/// Signed distances of points from a hyperplane, one a column, m.
[[nodiscard]] Eigen::VectorXd distances(const Positions<4>& positions,
                                        const FramedHyperplane& hyperplane);

}  // namespace pent::viewer
