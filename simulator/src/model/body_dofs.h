#pragma once

#include "linear/dof_map.h"
#include "model/bodies.h"
#include "model/held_vertices.h"

#include <vector>

namespace pent::simulator {

/// Numbers the vertices of some bodies that are free to move, as this rank has them in its matrix.
///
/// @param is_in  One entry a body.
template <int Dim>
[[nodiscard]] DofMap number_dofs(const Bodies<Dim>& bodies,
                                 const HeldVertices<Dim>& held,
                                 const std::vector<bool>& is_in);

/// The same vertices in an order that all ranks share.
template <int Dim>
[[nodiscard]] DofMap number_dofs_alike(const Bodies<Dim>& bodies,
                                       const HeldVertices<Dim>& held,
                                       const std::vector<bool>& is_in);

}  // namespace pent::simulator
