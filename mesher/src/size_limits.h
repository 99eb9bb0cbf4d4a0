#pragma once

#include <pent/simplex_mesh.h>

#include <string_view>

namespace pent::mesher {

/// Throws an Error unless the diagonal of the points' box is within 1e-30 to 1e30 m: hypervolumes,
/// sums of them and their squares then stay finite and above 0.
///
/// @param points  At least one.
/// @param what    As in "the surface".
template <int Dim>
void require_usual_size(const Positions<Dim>& points, std::string_view what);

}  // namespace pent::mesher
