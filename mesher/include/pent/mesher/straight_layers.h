#pragma once

#include <pent/extrusion.h>

#include <vector>

namespace pent::mesher {

/// Which part of a straight extrusion lies where the base was.
enum class Anchor {
    Middle,  ///< The extrusion reaches as far to either side.
    Start,   ///< The base is the first layer.
};

/// Layers of a straight extrusion in `slabs` equal steps; slabs + 1 of them.
///
/// @param direction  The whole extrusion, m; its last component is not 0.
template <int Dim>
[[nodiscard]] std::vector<Layer<Dim>> straight_layers(
    const Eigen::Matrix<double, Dim, 1>& direction, int slabs, Anchor anchor = Anchor::Middle);

/// The same with a layer at each of these places along the direction, in order.
template <int Dim>
[[nodiscard]] std::vector<Layer<Dim>> straight_layers(
    const Eigen::Matrix<double, Dim, 1>& direction, const std::vector<double>& places);

/// Number of slabs that makes the worst simplices of an extrusion best: height over 0.7 times the
/// mean edge of the base, rounded, at least 1.
[[nodiscard]] int automatic_slabs(double height, double mean_edge);

/// Mean length of the edges of a mesh, each counted once, m.
template <int Dim>
[[nodiscard]] double mean_edge(const SimplexMesh<Dim>& mesh);

}  // namespace pent::mesher
