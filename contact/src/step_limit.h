#pragma once

#include "candidates.h"

#include <pent/contact/contact_finder.h>

#include <vector>

namespace pent::contact {

/// How far a step may go under a barrier, without the seconds. Candidates cover it then, as far as
/// the surfaces of obstacles let it go.
///
/// @param vertices  Those that meet the surfaces of obstacles.
/// @param from, to  Of all vertices, those of cores too.
template <int Dim>
[[nodiscard]] StepLimit find_step_limit(Candidates<Dim>& candidates,
                                        const std::vector<std::uint32_t>& vertices,
                                        const PositionsView<Dim>& from,
                                        const PositionsView<Dim>& to);

}  // namespace pent::contact
