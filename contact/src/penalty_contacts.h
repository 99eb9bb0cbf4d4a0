#pragma once

#include "candidates.h"

#include <pent/contact/contact.h>

#include <vector>

namespace pent::contact {

/// The contacts of bodies under the penalty model at positions that the candidates cover, without
/// energies: by bodies, kind, and places in their surfaces.
template <int Dim>
[[nodiscard]] std::vector<Contact<Dim>> find_penalty_contacts(const Colliders<Dim>& colliders,
                                                              const Candidates<Dim>& candidates,
                                                              const PositionsView<Dim>& positions);

}  // namespace pent::contact
