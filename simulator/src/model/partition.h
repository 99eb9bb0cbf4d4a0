#pragma once

#include "linear/dof_map.h"

#include <pent/simplex_mesh.h>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// Shares vertices out to parts of about equal size, each compact: recursive coordinate bisection
/// [berger1987] of the middles of columns, whose vertices are kept together.
///
/// @param rest   Dim x vertices, m.
/// @param parts  At least 1.
/// @return       The part of every vertex. Throws an Error unless there are as many columns.
template <int Dim>
[[nodiscard]] std::vector<std::uint32_t> partition_columns(const Positions<Dim>& rest,
                                                           const Columns& columns,
                                                           int parts);

}  // namespace pent::simulator
