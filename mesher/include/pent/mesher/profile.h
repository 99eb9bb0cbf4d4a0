#pragma once

#include <pent/mesher/extrude.h>

#include <filesystem>
#include <vector>

namespace pent::mesher {

/// Reads the layers of an extrusion: one a line, in order, `#` for comments:
///
///     w scale [x y z [xy xz xw yz yw zw]]
///
/// The base is scaled, turned in the six planes by the angles (degrees, in that order; a plane "xw"
/// turns x towards w), and moved by (x, y, z, w) (m). What is left out is 0. Scale 0 makes a layer
/// a single point, for the first or the last one: a closed end.
/// Throws an Error that names file and line for what cannot be read, or fewer than two layers.
[[nodiscard]] std::vector<Layer<4>> read_profile(const std::filesystem::path& path);

/// Layers that make a round body of a base: scale sqrt(1 - (w / radius)^2) at equal steps of the
/// angle from w = -radius to radius, closed at both ends.
///
/// @param radius  Along w, m, not 0.
/// @param slabs   2 or more.
[[nodiscard]] std::vector<Layer<4>> round_layers(double radius, int slabs);

}  // namespace pent::mesher
