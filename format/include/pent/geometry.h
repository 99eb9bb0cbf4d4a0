#pragma once

#include <pent/simplex_mesh.h>

#include <cmath>

namespace pent {

/// The points p with normal . p = offset.
template <int Dim>
struct Hyperplane {
    Eigen::Matrix<double, Dim, 1> normal =
        Eigen::Matrix<double, Dim, 1>::Unit(Dim - 1);  ///< Of any length but 0.
    double offset = 0;                                 ///< m, times the length of the normal.
};

/// The edges of a cell from its first corner to the others, a column each: det is Dim! times its
/// volume.
template <int Dim>
[[nodiscard]] Eigen::Matrix<double, Dim, Dim> edge_matrix(const Positions<Dim>& positions,
                                                          const Simplices<Dim + 1>& cells,
                                                          Eigen::Index cell) {
    Eigen::Matrix<double, Dim, Dim> edges;
    for (int k = 0; k < Dim; ++k) {
        edges.col(k) = positions.col(cells(k + 1, cell)) - positions.col(cells(0, cell));
    }
    return edges;
}

/// The vector normal to the columns, of which there are one less than dimensions: n with
/// n . x = det[columns, x].
[[nodiscard]] Eigen::Vector2d normal_to(const Eigen::Matrix<double, 2, 1>& edges);
[[nodiscard]] Eigen::Vector3d normal_to(const Eigen::Matrix<double, 3, 2>& edges);
[[nodiscard]] Eigen::Vector4d normal_to(const Eigen::Matrix<double, 4, 3>& edges);

/// Outward normal of a facet: length (Dim - 1)! times its area, so zero where it has collapsed.
///
/// @param corners  A column each, in the outward order of FacetMatch::boundary.
template <int Dim>
[[nodiscard]] Eigen::Vector<double, Dim> facet_normal(
    const Eigen::Matrix<double, Dim, Dim>& corners) {
    const Eigen::Matrix<double, Dim, Dim - 1> edges =
        corners.template rightCols<Dim - 1>().colwise() - corners.col(0);
    // normal_to() has its vector last in the determinant, the outward rule first.
    return Dim % 2 == 0 ? Eigen::Vector<double, Dim>(-normal_to(edges)) : normal_to(edges);
}

/// The rotation in the plane of two different axes by an angle in radians: takes axis `from`
/// towards axis `to`, and leaves all others where they are.
template <int Dim>
[[nodiscard]] Eigen::Matrix<double, Dim, Dim> plane_rotation(int from, int to, double angle) {
    Eigen::Matrix<double, Dim, Dim> rotation = Eigen::Matrix<double, Dim, Dim>::Identity();
    rotation(from, from) = std::cos(angle);
    rotation(to, to) = std::cos(angle);
    rotation(from, to) = -std::sin(angle);
    rotation(to, from) = std::sin(angle);
    return rotation;
}

}  // namespace pent
