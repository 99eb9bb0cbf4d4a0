#pragma once

#include <pent/contact/closest_points.h>
#include <pent/contact/filter.h>

#include <cstdint>

namespace pent::contact {

/// How far inside a penalty goes on pushing.
enum class Reach : std::uint8_t {
    AnyDepth,  ///< The parabola goes on: the force grows linearly with depth.
    Fading,    ///< The force has faded to 0 at a depth of `distance`, beyond which nobody looks.
};

/// A penalty energy of a signed distance d: positive outside, negative inside.
///
///     psi(d) = 0                                                  d >= eps
///              k (d - eps)^2                                      0 <= d < eps, [shi2025] Eq. 24
///              the same                                           d < 0, AnyDepth
///              k (eps^2 - 2 eps d + d^2 + 4 d^3 / (3 eps))        -eps < d < 0, Fading
///
/// psi and psi' are continuous, psi'' at d = 0 too. Eq. 24 drops to zero force at depth eps; with
/// AnyDepth nothing is dropped. Fading is for pairs that only tell a crossing while it is shallow: its
/// force -psi' = 2 k (eps + d)(eps - 2 d) / eps is largest, 2.25 k eps, at d = -eps / 4. Where it has
/// faded out, at d = -eps, its energy, 8/3 k eps^2, is let go: a jump of psi to 0, with no force.
struct Penalty {
    double distance = 0;   ///< eps, m, > 0.
    double stiffness = 0;  ///< k, J/m^2 = N/m for a force of 2 k (eps - d), > 0.
    Reach reach = Reach::AnyDepth;
};

[[nodiscard]] double penalty_energy(double signed_distance, const Penalty& penalty);     ///< J.
[[nodiscard]] double penalty_slope(double signed_distance, const Penalty& penalty);      ///< J/m.
[[nodiscard]] double penalty_curvature(double signed_distance, const Penalty& penalty);  ///< J/m^2.

/// Energy of one contact and its derivatives by one moving point.
///
/// For a pair with weights w, the force on point i is -w_i gradient, and block (i, j) of the
/// Hessian is w_i w_j hessian: a Dim x Dim matrix is all there is to scatter.
template <int Dim>
struct Response {
    double energy = 0;                        ///< J.
    Vector<Dim> gradient;                     ///< N.
    Eigen::Matrix<double, Dim, Dim> hessian;  ///< N/m, symmetric.
};

/// Response of a pair of simplices, with the weights held.
///
/// psi'' u u^T + (psi' / d)(I - u u^T), its two eigenvalues filtered. psi' / d has no bound at d = 0
/// and exists only since the weights are held; both filters cut its size at |psi''| so that
/// touching pairs are not glued to each other sideways.
/// Source: [shi2025] Eqs. 35-37.
///
/// @param signed_distance  d, m.
/// @param direction        u, unit length: the direction in which d grows.
/// @param weight           Factor of the energy, >= 0; held.
template <int Dim>
[[nodiscard]] Response<Dim> pair_response(double signed_distance,
                                          const Vector<Dim>& direction,
                                          const Penalty& penalty,
                                          double weight,
                                          Filter filter);

}  // namespace pent::contact
