#pragma once

#include <pent/pent_file.h>
#include <pent/simplex_mesh.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace pent {

/// The cells of a mesh, each with its corners in the order of its edges' directions.
template <int Dim>
struct OrderedCells {
    Simplices<Dim + 1> cells;
    std::vector<std::uint8_t> is_odd;  ///< Ordering the cell's corners was an odd permutation.
};

/// Where one layer of vertices lies: base vertex x goes to linear * x + offset.
///
/// With linear zero the layer is a single point: an end of a closed shape.
template <int Dim>
struct Layer {
    Eigen::Matrix<double, Dim, Dim - 1> linear;  ///< Dimensionless.
    Eigen::Matrix<double, Dim, 1> offset;        ///< m.

    [[nodiscard]] bool is_point() const { return (linear.array() == 0).all(); }
};

struct ExtrudeOptions {
    /// Reverses the order of the corners in every second slab: neighbors mirror each other and the
    /// lean of the diagonals cancels.
    bool alternate = true;
};

/// What a body is extruded from.
template <int Dim>
struct Extrusion {
    SimplexMesh<Dim - 1> base;      ///< Of it positions, cells and regions count.
    OrderedCells<Dim - 1> ordered;  ///< Its cells.
    std::vector<Layer<Dim>> layers;
    ExtrudeOptions options;
};

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
/// @param ordered  Its cells in an order without cycles, see mesher::order_cells().
/// @param layers   Two or more; only the first and the last may be points, and not both when there
///                 are only two.
/// Throws an Error if the result would have more than 2^32 - 1 vertices. Not checked: whether cells
/// come out inverted or flat, as in a profile that turns back; see validate().
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> extrude(const SimplexMesh<Dim - 1>& base,
                                       const OrderedCells<Dim - 1>& ordered,
                                       const std::vector<Layer<Dim>>& layers,
                                       const ExtrudeOptions& options = {});

/// The vertices alone of what extrude() makes, for a mesh whose cells are made in parts.
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> extrude_vertices(const Extrusion<Dim>& extrusion);

/// The cells alone that extrude() makes over some of the base cells, with their regions.
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> extrude_cells(const Extrusion<Dim>& extrusion,
                                             std::span<const std::uint32_t> base_cells);

/// How many cells there are over each base cell.
template <int Dim>
[[nodiscard]] Eigen::Index cells_of_column(const std::vector<Layer<Dim>>& layers);

/// Writes base and layers as write_mesh() writes a mesh: a .pent file that read_mesh() extrudes.
/// Throws an Error unless read_extrusion() would take them.
/// @return  The checksum in the header.
template <int Dim>
std::uint32_t write_extrusion(const std::filesystem::path& path,
                              const Extrusion<Dim>& extrusion,
                              const WriteOptions& options = {});

/// Reads them. Throws an Error as read_mesh() does, for a file that holds a mesh, for orders in
/// which neighbors do not agree, and for layers that extrude() does not take; whether cells come
/// out inverted is not checked.
template <int Dim>
[[nodiscard]] Extrusion<Dim> read_extrusion(const std::filesystem::path& path);

}  // namespace pent
