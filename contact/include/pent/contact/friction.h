#pragma once

#include <pent/contact/length.h>
#include <pent/contact/penalty.h>

#include <array>
#include <cstdint>

namespace pent::contact {

/// Coulomb friction, smoothed at rest.
struct Friction {
    double coefficient = 0;  ///< mu, >= 0.
    double slip_speed =
        1e-3;  ///< m/s, > 0: what moves slower than that sticks, as if in thick honey.
};

/// One contact as friction sees it, lagged: normal, force and weights are those at the start of the
/// time step and are held during it, which makes friction the gradient of an energy. For a vertex and
/// an obstacle there is one point, of weight 1; unused vertices have weight 0.
/// Source: [li2020] section 5.4; the tangent space has Dim - 1 dimensions, so there is no basis to
/// choose: what counts is the length of the slip u = (I - n n^T) sum w_i (x_i - x_i at the start).
template <int Dim>
struct FrictionContact {
    std::array<std::uint32_t, Dim + 1> vertices{};
    Weights<Dim> weights;
    int count = Dim + 1;  ///< Vertices in use.
    Vector<Dim> normal;   ///< n, unit length.
    double force = 0;     ///< mu times the normal force, N, >= 0.
};

/// What friction does to the slip in one step.
enum class FrictionLaw : std::uint8_t {
    Energy,  ///< Gradient and Hessian of the energy at the slip: for Newton's method.
    Secant,  ///< The resistance that at this slip gives this force, held: for a single linear solve.
};

/// Response by the slip of sum w_i x_i: the force on point i is -w_i gradient, and block (i, j) of the
/// Hessian is w_i w_j hessian.
///
/// The energy is force f0(|u|) with f0' = f1, f1(y) = 2 y/e - y^2/e^2 below e = slip_speed h and 1 beyond:
/// convex, so the Hessian is positive semidefinite as it is, with eigenvalues f1' along the slip and
/// f1/|u| across it. The force never points along the slip: friction only takes energy.
///
/// @param slip  sum w_i (x_i - x_i at the start), m; its part along the normal is of no effect.
/// @param h     Length of the time step, s.
template <int Dim>
[[nodiscard]] Response<Dim> friction_response(const FrictionContact<Dim>& contact,
                                              const Vector<Dim>& slip,
                                              const Friction& friction,
                                              double h,
                                              FrictionLaw law);

}  // namespace pent::contact
