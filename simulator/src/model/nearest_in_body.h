#pragma once

#include "model/bodies.h"
#include "model/nearest_point.h"

#include <pent/parallel.h>

#include <cstdint>
#include <vector>

namespace pent::simulator {

template <int Dim>
using MaterialPoints = std::vector<MaterialPoint<Dim>>;

/// The point of a body that is nearest to each of some vertices, at rest. Of cells that are equally
/// near but for rounding the first counts, as Bodies has them. On all ranks alike, whichever of
/// them has the cell.
///
/// @param body      Whose cells are searched; on all ranks together at least one.
/// @param vertices  Of all bodies, the same on all ranks.
/// @return          One a vertex.
template <int Dim>
[[nodiscard]] MaterialPoints<Dim> nearest_in_body(const Workers& workers,
                                                  const Bodies<Dim>& bodies,
                                                  std::size_t body,
                                                  const std::vector<std::uint32_t>& vertices);

}  // namespace pent::simulator
