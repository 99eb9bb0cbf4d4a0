#pragma once

#include <pent/mesher/boundary_solid.h>

namespace pent::mesher {

/// Makes a hypersurface a cycle, in which as many tetrahedra see every triangle from one side as
/// from the other. Then it winds around every point a whole number of times.
///
/// Points at the same place become one. Of tetrahedra on the same corners those that face each
/// other cancel. If that is a cycle it stays as it is, whatever crosses or touches. Else
/// tetrahedra turn over to agree with their neighbors, and each hole, a connected part of the
/// triangles that are still out of balance, gets a cone from its middle.
///
/// Throws an Error that begins with `name` if nothing is left, for a hole that takes more than a
/// quarter of what is there to close, or for what is not within 1e-30 to 1e30 m across.
[[nodiscard]] exchange::TetSurface closed_boundary(const exchange::TetSurface& surface,
                                                   const std::string& name,
                                                   BoundaryReport& report);

}  // namespace pent::mesher
