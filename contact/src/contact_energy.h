#pragma once

#include <pent/contact/contact_scene.h>
#include <pent/contact/filter.h>

namespace pent::contact {

/// Corners of a contact, in its order; columns beyond are 0.
///
/// @param positions  Of all vertices, those of cores too; also below.
template <int Dim>
[[nodiscard]] Stencil<Dim> corners_of(const Contact<Dim>& contact,
                                      const PositionsView<Dim>& positions);

/// Sets energy and slope of a contact, and returns whether its mollifier adds to the gradient.
template <int Dim>
bool evaluate(const DistanceEnergy& energy,
              const PositionsView<Dim>& positions,
              Contact<Dim>& contact);

/// The part of the gradient that the mollifier of a contact adds.
template <int Dim>
[[nodiscard]] StencilVector<Dim> mollifier_gradient(const DistanceEnergy& energy,
                                                    const Contact<Dim>& contact,
                                                    const PositionsView<Dim>& positions);

/// Filtered Hessian of a pair of simplices with its weights and its share held:
///
///     psi'' u u^T + (psi' / d)(I - u u^T)
///
/// psi' / d has no bound at d = 0 and exists only since the weights are held; both filters cut its
/// size at |psi''| so that touching pairs are not glued to each other sideways. Source: [shi2025]
/// Eqs. 35-37.
template <int Dim>
[[nodiscard]] Block<Dim> held_hessian(const DistanceEnergy& energy,
                                      const Contact<Dim>& contact,
                                      Filter filter);

/// Filtered Hessian of a vertex at the surface of an obstacle, at any depth.
template <int Dim>
[[nodiscard]] Block<Dim> surface_hessian(const DistanceEnergy& energy,
                                         const SignedDistance<Dim>& distance,
                                         Filter filter);

/// Finds energies and slopes of contacts in parallel, and their sums.
///
/// @param contacts  Without energies; moved through, so that nothing is copied.
template <int Dim>
[[nodiscard]] Contacts<Dim> evaluate_all(const ContactScene<Dim>& scene,
                                         const PositionsView<Dim>& positions,
                                         double stiffness,
                                         Contacts<Dim> contacts);

/// Filtered Hessians of all contacts, in their order. Parallel.
///
/// @param memory  Lists to write to: of the last time, so that nothing is allocated.
template <int Dim>
[[nodiscard]] StencilHessians<Dim> hessians_of(const ContactScene<Dim>& scene,
                                               const Contacts<Dim>& contacts,
                                               const PositionsView<Dim>& positions,
                                               double stiffness,
                                               Filter filter,
                                               StencilHessians<Dim> memory);

}  // namespace pent::contact
