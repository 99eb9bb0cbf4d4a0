#pragma once

#include "colliders.h"

#include <pent/contact/crossings.h>

#include <vector>

namespace pent::contact {

/// All that crosses, touches or is inside something else, no more than `most`, in order of
/// colliders, then of obstacles. Pairs have to be further apart than the separation and than
/// rounding (1e-12 of the largest coordinate). Fixed vertices alone may touch.
///
/// @param vertices   Those that meet the surfaces of obstacles.
/// @param positions  Of all vertices, those of cores too.
template <int Dim>
[[nodiscard]] std::vector<Crossing> find_crossings(const Colliders<Dim>& colliders,
                                                   const std::vector<std::uint32_t>& vertices,
                                                   const PositionsView<Dim>& positions,
                                                   std::size_t most);

}  // namespace pent::contact
