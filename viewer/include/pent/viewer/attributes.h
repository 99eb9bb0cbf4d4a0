#pragma once

#include <pent/pent_file.h>
#include <pent/simplex_mesh.h>
#include <pent/viewer/boundary.h>
#include <pent/viewer/surface.h>

#include <Eigen/Core>

#include <cmath>

namespace pent::viewer {

/// Length of each column of a matrix, also where squares leave the range of numbers.
template <typename Vectors>
[[nodiscard]] Eigen::VectorXd lengths(const Vectors& vectors) {
    constexpr double kSmall = 1e-150;  // below, squares lose digits
    Eigen::VectorXd lengths = vectors.colwise().norm().transpose();
    for (Eigen::Index i = 0; i < lengths.size(); ++i) {
        if (!(std::isfinite(lengths[i]) && lengths[i] > kSmall)) {
            lengths[i] = vectors.col(i).stableNorm();
        }
    }
    return lengths;
}

/// Length of the velocity of each vertex, m/s; zero where the frame has no velocities.
template <int Dim>
[[nodiscard]] Eigen::VectorXd vertex_speed(const Frame<Dim>& frame);

/// Length of the contact force on each vertex, N. The frame must have them.
template <int Dim>
[[nodiscard]] Eigen::VectorXd vertex_force(const Frame<Dim>& frame);

/// How much each vertex's surroundings are strained, dimensionless: the mean over the cells at the
/// vertex, weighted by their rest volumes, of |E|, the Frobenius norm of the Green strain
///
///     E = (F^T F - I) / 2.
///
/// Zero at every rigid motion of the mesh: the strain of a cell counts as zero below what the
/// rounding of coordinates makes of it, 16 eps |x| |Dm^-1|, where |x| is the largest coordinate at
/// rest or now and Dm holds the edges of the cell at rest.
template <int Dim>
[[nodiscard]] Eigen::VectorXd vertex_strain(const SimplexMesh<Dim>& rest,
                                            const Positions<Dim>& positions);

/// The mean of a quantity of cells over the cells at each vertex, weighted by their volumes; zero
/// at a vertex of none.
///
/// @param values  A column a cell; a column a vertex comes back.
template <int Dim>
[[nodiscard]] Eigen::MatrixXd vertex_means(const SimplexMesh<Dim>& mesh,
                                           const Eigen::MatrixXd& values);

/// The w coordinate of each vertex, m; zero in three dimensions.
template <int Dim>
[[nodiscard]] Eigen::VectorXd vertex_w(const Positions<Dim>& positions);

/// Radians: the crease of pictures. Edges of boxes stay sharp, coarse organic shapes smooth.
inline constexpr double kCrease = 1.0;

/// Outward normals for smooth shading, one per corner of each triangle of a surface: 3 x 3
/// triangles.
///
/// They come from the boundary of the body in R^Dim, averaged over the facets around each vertex
/// that are within `crease` of the facet, and are then projected into the picture. So they do not
/// suffer from slivers and zero-area triangles of a slice. A corner whose projected normal vanishes
/// gets that of its triangle; in a triangle of zero area it may be zero. Unit length otherwise.
///
/// @param axes    3 x Dim: the picture's axes, the upper rows of the hyperplane's frame.
/// @param crease  Radians; facets that meet at a sharper angle keep a visible edge.
template <int Dim>
[[nodiscard]] Positions<3> corner_normals(const Surface& surface,
                                          const Boundary<Dim>& boundary,
                                          const Positions<Dim>& positions,
                                          const Eigen::Matrix<double, 3, Dim>& axes,
                                          double crease);

/// The same from triangles alone, for surfaces without slivers.
[[nodiscard]] Positions<3> corner_normals(const TriangleMesh& mesh, double crease);

}  // namespace pent::viewer
