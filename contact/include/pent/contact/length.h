#pragma once

#include <pent/contact/closest_points.h>

namespace pent::contact {

/// The Dim + 1 points of a pair, one a column, m: corners of the first simplex, then of the second.
template <int Dim>
using Stencil = Eigen::Matrix<double, Dim, Dim + 1>;

/// Weights w of these points, dimensionless: beta of the first simplex, -alpha of the second.
template <int Dim>
using Weights = Eigen::Matrix<double, Dim + 1, 1>;

/// Derivatives by all coordinates of a stencil, in the order x0 y0 z0 w0 x1 ...
template <int Dim>
using StencilVector = Eigen::Matrix<double, Dim*(Dim + 1), 1>;
template <int Dim>
using StencilMatrix = Eigen::Matrix<double, Dim*(Dim + 1), Dim*(Dim + 1)>;

/// Unsigned length l = |sum w_i v_i| of a weighted combination of points, m.
///
/// The weights are held: their own motion is not in the derivatives below.
/// Source: [shi2025] Eqs. 27-34.
template <int Dim>
[[nodiscard]] double length(const Stencil<Dim>& points, const Weights<Dim>& weights);

/// Gradient w (x) u, u being the unit vector along sum w_i v_i; zero where l = 0.
template <int Dim>
[[nodiscard]] StencilVector<Dim> length_gradient(const Stencil<Dim>& points,
                                                 const Weights<Dim>& weights);

/// Hessian w w^T (x) (I - u u^T) / l, 1/m: positive semidefinite; zero where l = 0.
template <int Dim>
[[nodiscard]] StencilMatrix<Dim> length_hessian(const Stencil<Dim>& points,
                                                const Weights<Dim>& weights);

/// Eigensystem of the Hessian of an energy psi(l) with the weights held.
///
/// One eigenvector along w (x) u, Dim - 1 along w (x) (vectors normal to u); all others have
/// eigenvalue 0. |w|^2 = sum beta^2 + sum alpha^2 is in both eigenvalues.
/// Source: [shi2025] Eqs. 36-37, with |w|^2 of two simplices in place of 1 + sum alpha^2.
template <int Dim>
struct LengthEigensystem {
    double compression = 0;  ///< psi'' |w|^2, J/m^2, once.
    double buckling = 0;     ///< psi' |w|^2 / l, J/m^2, Dim - 1 times.
    Vector<Dim> direction;   ///< u.
};

/// @param slope      psi'(l), J/m.
/// @param curvature  psi''(l), J/m^2.
/// The points must not have length 0, where there is no direction; asserted.
template <int Dim>
[[nodiscard]] LengthEigensystem<Dim> length_eigensystem(const Stencil<Dim>& points,
                                                        const Weights<Dim>& weights,
                                                        double slope,
                                                        double curvature);

}  // namespace pent::contact
