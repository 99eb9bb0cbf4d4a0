#pragma once

#include <pent/mesher/edge_order.h>
#include <pent/simplex_mesh.h>

#include <cstdint>
#include <vector>

namespace pent::mesher {

/// Where one layer of vertices lies: base vertex x goes to linear * x + offset.
///
/// With linear zero the layer is a single point: an end of a closed shape.
template <int Dim>
struct Layer {
    Eigen::Matrix<double, Dim, Dim - 1> linear;  ///< Dimensionless.
    Eigen::Matrix<double, Dim, 1> offset;        ///< m.

    [[nodiscard]] bool is_point() const { return (linear.array() == 0).all(); }
};

/// Which part of a straight extrusion lies where the base was.
enum class Anchor {
    Middle,  ///< The extrusion reaches as far to either side.
    Start,   ///< The base is the first layer.
};

struct ExtrudeOptions {
    /// Reverses the order of the corners in every second slab: neighbors mirror each other and the
    /// lean of the diagonals cancels.
    bool alternate = true;
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

/// Extrudes a mesh through layers and fills each prism with Dim simplices [shi2025, Sec. 3].
///
/// The prism over ordered corners v0..vd gets the simplices {b0..bk, tk..td}, k = 0..d, of its
/// bottom b and top t. Neighbors agree because the cut of each common face depends on the order of
/// its own corners alone.
///
/// Vertices are numbered along the columns: column c, layer l is c * layers + l, which keeps
/// neighbors in memory together; a point layer comes last, as a column of its own. Cells come by
/// base cell, then slab, then k. All are positively oriented if the layers proceed to one side.
///
/// @param base     Positively oriented.
/// @param ordered  Its cells in an order without cycles, see order_cells().
/// @param layers   Two or more; only the first and the last may be points, and not both when there
///                 are only two.
/// Throws an Error if the result would have more than 2^32 - 1 vertices. Not checked: whether cells
/// come out inverted or flat, as in a profile that turns back; see validate().
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> extrude(const SimplexMesh<Dim - 1>& base,
                                       const OrderedCells<Dim - 1>& ordered,
                                       const std::vector<Layer<Dim>>& layers,
                                       const ExtrudeOptions& options = {});

}  // namespace pent::mesher
