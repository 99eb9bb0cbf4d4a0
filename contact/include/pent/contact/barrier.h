#pragma once

#include <pent/contact/length.h>
#include <pent/contact/penalty.h>

#include <cmath>
#include <cstdint>

namespace pent::contact {

/// A barrier energy of a distance d: nothing from far, without bound as d falls to `separation`.
///
///     psi(d) = -k dhat^2 (y - 1)^2 ln y,   y = (gap / dhat)^2,   gap = d - separation
///
/// for 0 < gap < dhat, 0 beyond: twice continuously differentiable. Infinite where gap <= 0.
/// Source: [li2020] Eq. 6, scaled so that k is a stiffness; separation as in [li2021].
struct Barrier {
    double distance = 0;    ///< dhat, m, > 0: the gap at which it begins.
    double stiffness = 0;   ///< k, N/m, > 0.
    double separation = 0;  ///< m, >= 0: distance that is never reached.
};

[[nodiscard]] double barrier_energy(double distance, const Barrier& barrier);     ///< J.
[[nodiscard]] double barrier_slope(double distance, const Barrier& barrier);      ///< J/m, <= 0.
[[nodiscard]] double barrier_curvature(double distance, const Barrier& barrier);  ///< J/m^2, >= 0.

/// The nearest faces of two simplices that do not touch, as one list of corners.
template <int Dim>
struct NearestFaces {
    std::uint8_t first_count = 0;  ///< Corners of the first simplex, which come first.
    std::uint8_t count = 0;        ///< All corners, at most Dim + 1.
    std::uint8_t active = 0;       ///< Bit i: corner i spans one of the nearest faces.
    Weights<Dim> weights;          ///< beta, then -alpha; 0 where not active, and beyond `count`.
    Vector<Dim> direction;         ///< Unit length, from the second to the first.
    double distance = 0;           ///< m, > 0.
};

/// All corners of two simplices, and which of them span the nearest faces. They must not touch.
template <int Dim, int K, int L>
[[nodiscard]] NearestFaces<Dim> nearest_faces(const ClosestPoints<Dim, K, L>& points) {
    NearestFaces<Dim> faces;
    faces.first_count = K;
    faces.count = K + L;
    faces.active = static_cast<std::uint8_t>(points.first_face | points.second_face << K);
    faces.weights << points.beta, -points.alpha;
    faces.distance = std::sqrt(points.distance_squared);
    faces.direction = points.difference / faces.distance;
    return faces;
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
/// Its range is spanned by {w, W} (x) u, w (x) E and w (x) (what is normal to u and E): at most
/// 2 Dim - 1 dimensions. The filter works there, on a matrix of that size, and is the same as one on
/// all eigenvalues. Faces whose edges are dependent to rounding move as if their weights were held.
///
/// @param points     Corners in the order of `faces`; columns beyond faces.count are not read.
/// @param slope      psi'(d), J/m.
/// @param curvature  psi''(d), J/m^2.
template <int Dim>
[[nodiscard]] StencilMatrix<Dim> distance_energy_hessian(const Stencil<Dim>& points,
                                                         const NearestFaces<Dim>& faces,
                                                         double slope,
                                                         double curvature,
                                                         Filter filter);

/// How far the mixed pair (edge and ridge: Dim + 1 corners, the edge first) is from parallel: the
/// squared volume |e ^ t1 ^ ...|^2 of the box spanned by the edge and the edges of the ridge, m^(2
/// (Dim - 1)). In R^3 it is |e1 x e2|^2; it is 0 where the edge has a direction of the ridge's plane, and
/// only there, or where one of them has collapsed.
template <int Dim>
[[nodiscard]] double spanned_volume_squared(const Stencil<Dim>& points);
template <int Dim>
[[nodiscard]] StencilVector<Dim> spanned_volume_squared_gradient(const Stencil<Dim>& points);
template <int Dim>
[[nodiscard]] StencilMatrix<Dim> spanned_volume_squared_hessian(const Stencil<Dim>& points);

/// What takes the energy of a mixed pair to 0 where it becomes parallel, and its closest points jump:
/// m(c) = (c / c0) (2 - c / c0) for c < c0, 1 beyond; continuously differentiable.
/// Source: [li2020] section 5.2, with the spanned volume in place of the cross product.
struct Mollifier {
    double threshold = 0;  ///< c0, unit of c; 0 for a pair that needs none.

    [[nodiscard]] double value(double c) const {
        return c < threshold ? c / threshold * (2 - c / threshold) : 1;
    }
    [[nodiscard]] double slope(double c) const {
        return c < threshold ? 2 / threshold * (1 - c / threshold) : 0;
    }
    [[nodiscard]] double curvature(double c) const {
        return c < threshold ? -2 / (threshold * threshold) : 0;
    }
};

/// Energy of a pair and its derivatives by the coordinates of its corners, J, N, N/m.
///
/// A pair with a mollifier is mixed and has all its Dim + 1 corners in `faces`, the edge first.
template <int Dim>
[[nodiscard]] double pair_barrier_energy(const Stencil<Dim>& points,
                                         const NearestFaces<Dim>& faces,
                                         const Barrier& barrier,
                                         const Mollifier& mollifier);
template <int Dim>
[[nodiscard]] StencilVector<Dim> pair_barrier_gradient(const Stencil<Dim>& points,
                                                       const NearestFaces<Dim>& faces,
                                                       const Barrier& barrier,
                                                       const Mollifier& mollifier);
template <int Dim>
[[nodiscard]] StencilMatrix<Dim> pair_barrier_hessian(const Stencil<Dim>& points,
                                                      const NearestFaces<Dim>& faces,
                                                      const Barrier& barrier,
                                                      const Mollifier& mollifier,
                                                      Filter filter);

}  // namespace pent::contact
