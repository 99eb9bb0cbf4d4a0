#pragma once

#include <pent/mesher/straight_layers.h>

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

/// Layers that make a round body of a base: scale sqrt(1 - (w / radius)^2) at places of half
/// a meridian from w = -radius to radius, closed at both ends.
///
/// @param radius  Along w, m, not 0.
/// @param places  -1/2 for the first end to 1/2 for the last, 0 for the widest layer; 3 or more.
[[nodiscard]] std::vector<Layer<4>> round_layers(double radius, const std::vector<double>& places);

/// Length of the polyline through the offsets of the layers, m.
[[nodiscard]] double path_length(const std::vector<Layer<4>>& layers);

/// Where the polyline through the offsets of the layers first crosses w = 0, as a share of its
/// length; where it does not, the end that is nearer to w = 0. 0 for layers that only turn or
/// scale, whose polyline has no length.
[[nodiscard]] double slice_on_path(const std::vector<Layer<4>>& layers);

/// Resamples the layers of a body: at these places along the polyline through their offsets, each
/// interpolated linearly between the two layers that it lies between. Columns of vertices were
/// straight from layer to layer and are so again; a bend at which no new layer lies is cut off.
///
/// @param places  Shares of the length of the polyline, from 0 to 1.
/// Throws an Error if two layers in a row have one offset, or nothing is left between two points.
[[nodiscard]] std::vector<Layer<4>> relayer(const std::vector<Layer<4>>& layers,
                                            const std::vector<double>& places);

}  // namespace pent::mesher
