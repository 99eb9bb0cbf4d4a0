#pragma once

#include "spectra.h"

#include <pent/contact/contact.h>

namespace pent::contact {

/// w (x) u of a stencil.
template <int Dim>
[[nodiscard]] StencilVector<Dim> outer(const Weights<Dim>& weights, const Vector<Dim>& direction) {
    StencilVector<Dim> product;
    for (int i = 0; i <= Dim; ++i) {
        product.template segment<Dim>(Dim * i) = weights[i] * direction;
    }
    return product;
}

/// Hessian of psi(d), d being the distance of the affine hulls of the nearest faces: exact, so the
/// weights move with the corners.
///
/// With u the direction, w the weights, E the edges of the active faces (x - y = offset + E t), M =
/// E^T E and W = dw/dt:
///
///     psi'' (w w^T (x) u u^T) + (psi'/d) (w w^T (x) (I - E M^-1 E^T - u u^T)
///         - d (W M^-1 E^T (x) ... + its transpose) - d^2 W M^-1 W^T (x) u u^T)
///
/// Its range is in the span of {w, W} (x) u, w (x) E and w (x) (what is normal to u and E): at most
/// 2 Dim - 1 dimensions. It is 0 on all of w (x) E, so that at most Dim eigenvalues are above 0.
/// Faces whose edges are dependent to rounding move as if their weights were held.
///
/// @param points     Corners of the contact, in its order; columns beyond are not read.
/// @param slope      psi'(d), J/m.
/// @param curvature  psi''(d), J/m^2.
template <int Dim>
[[nodiscard]] ReducedMatrix<Dim, 2 * Dim - 1> distance_hessian(const Stencil<Dim>& points,
                                                               const Contact<Dim>& contact,
                                                               double slope,
                                                               double curvature);

}  // namespace pent::contact
