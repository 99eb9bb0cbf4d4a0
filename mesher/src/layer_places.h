#pragma once

#include <vector>

namespace pent::mesher {

/// Where layers lie along an extrusion: places relative to the slice that is looked at, from -slice
/// to 1 - slice, the whole extrusion being 1 long. One more than there are slabs between them.
///
/// `slice` is where the slice divides the extrusion: 0 at its start, 1/2 in its middle, 1 at its
/// end. Where it is in the middle, places are symmetric to the last bit.

/// All slabs of one height.
[[nodiscard]] std::vector<double> even_places(int slabs, double slice);

/// Slabs that grow away from the slice: at u slabs from it lies the place h (growth^u - 1) /
/// (growth - 1), whether u is whole or not, so that one slab more makes the next `growth` times as
/// high. A slice in the middle of an odd number lies in the middle of a slab.
///
/// @param growth  1 or more. Throws an Error if the highest slab would be more than a million times
///                as high as the lowest.
[[nodiscard]] std::vector<double> graded_places(int slabs, double growth, double slice);

/// How many slabs of graded_places() make the lowest one `lowest` high, of an extrusion that is 1
/// long; at least 1.
[[nodiscard]] int graded_slabs(double lowest, double growth, double slice);

/// Slabs of these heights from the slice outward, to either side of it, each side shared out in
/// proportion. Throws an Error unless all are finite and above 0.
[[nodiscard]] std::vector<double> listed_places(const std::vector<double>& heights, double slice);

}  // namespace pent::mesher
