#pragma once

#include <pent/contact/stencil.h>

#include <Eigen/LU>

namespace pent::contact {

/// Squared volume of the box that the edges of a simplex span from its first corner, m^(2 (Count -
/// 1)).
template <int Dim, int Count>
[[nodiscard]] double spanned_squared(const Corners<Dim, Count>& corners) {
    const Eigen::Matrix<double, Dim, Count - 1> edges =
        corners.template rightCols<Count - 1>().colwise() - corners.col(0);
    return (edges.transpose() * edges).determinant();
}

/// How far a mixed pair (edge and ridge: Dim + 1 corners) is from parallel: the squared volume |e ^
/// t1 ^ ...|^2 of the box spanned by the edge and the edges of the ridge, m^(2 (Dim - 1)). In R^3
/// it is |e1 x e2|^2; it is 0 where the edge has a direction of the ridge's plane, and only there,
/// or where one of them has collapsed.
///
/// @param first_count  Corners of the simplex that comes first: 2 for the edge, Dim - 1 for the
/// ridge.
template <int Dim>
[[nodiscard]] double spanned_volume_squared(const Stencil<Dim>& points, int first_count = 2);
template <int Dim>
[[nodiscard]] StencilVector<Dim> spanned_volume_squared_gradient(const Stencil<Dim>& points,
                                                                 int first_count = 2);
template <int Dim>
[[nodiscard]] StencilMatrix<Dim> spanned_volume_squared_hessian(const Stencil<Dim>& points,
                                                                int first_count = 2);

}  // namespace pent::contact
