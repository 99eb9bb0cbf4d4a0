#pragma once

#include "candidates.h"

#include <pent/contact/contact.h>

#include <vector>

namespace pent::contact {

/// Mixed pairs spanning less than this part of the squared volume that they would span at rest if
/// they were normal to each other are nearly parallel [li2020].
inline constexpr double kNearlyParallel = 1e-3;

template <int Dim>
struct BarrierContacts {
    std::vector<Contact<Dim>> list;
    std::int64_t candidates = 0;  ///< Pairs of simplices that were looked at.
};

/// The contacts of a barrier between bodies, and of bodies and cores of obstacles, at positions
/// that the candidates cover, without energies.
///
/// Pairs of simplices whose nearest faces are the same are one contact with a multiplicity; a pair
/// that is nearly parallel has all its corners and a mollifier.
///
/// @param positions  Of all vertices, those of cores too.
template <int Dim>
[[nodiscard]] BarrierContacts<Dim> find_barrier_contacts(const Colliders<Dim>& colliders,
                                                         const Candidates<Dim>& candidates,
                                                         const PositionsView<Dim>& positions);

}  // namespace pent::contact
