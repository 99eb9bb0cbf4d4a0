#pragma once

#include <pent/simplex_mesh.h>

#include <string_view>

namespace pent::mesher {

/// Throws an Error unless the diagonal of the points' box is within 1e-30 to 1e30 m: hypervolumes,
/// sums of them and their squares then stay finite and above 0.
/// @param what  As in "the surface".
void require_usual_size(const Positions<3>& points, std::string_view what);

}  // namespace pent::mesher
