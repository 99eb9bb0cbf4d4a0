#pragma once

#include "model/bodies.h"

#include <pent/mesh_part.h>
#include <pent/simulator/ranks.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace pent::simulator {

/// Whether ranks have parts of meshes: all vertices, and of the cells none but those of `cells`, in
/// whose order labels of regions are.
template <int Dim>
[[nodiscard]] bool is_of_parts(const Bodies<Dim>& bodies) {
    return bodies.cell_count > 0 && bodies.meshes.front().cell_count() == 0;
}

// Steps of make_bodies(), which are those of parts, too.

/// Throws an Error unless the scene passes check(), is of this dimension and has so many bodies.
template <int Dim>
void check_meshes(const Scene& scene, std::size_t meshes);

/// Finds masses and the large energy; all else of the bodies is to be there, of parts also the
/// sharing. Throws an Error for a vertex without mass.
template <int Dim>
void lump_masses(const Scene& scene, Bodies<Dim>& bodies);

/// The same as make_bodies() and keep_near_cells() make of whole meshes, from the parts that this
/// rank has. Throws an Error on all ranks as make_bodies() does, where vertices differ between
/// ranks, and without ranks.
template <int Dim>
[[nodiscard]] Bodies<Dim> make_part_bodies(const Scene& scene,
                                           std::vector<MeshPart<Dim>> parts,
                                           const std::shared_ptr<const Ranks>& ranks);

/// Facets of the boundary of a body, outward, with the indices of its mesh, in the order of
/// match_facets(). Ranks with parts of meshes find it together.
template <int Dim>
[[nodiscard]] Simplices<Dim> boundary_of(const Bodies<Dim>& bodies, std::size_t body);

/// Cells of a scene, which have the scene's vertices.
template <int Dim>
struct CellList {
    std::vector<Eigen::Matrix<std::uint32_t, Dim + 1, 1>> cells;  ///< Body by body, in order.
    std::vector<std::size_t> bodies;                              ///< One a cell.
};

/// The cells that are wanted, on all ranks alike.
///
/// @param is_wanted  Of the corners of a cell.
template <int Dim>
[[nodiscard]] CellList<Dim> list_cells(
    const Bodies<Dim>& bodies,
    const std::function<bool(const Eigen::Matrix<std::uint32_t, Dim + 1, 1>&)>& is_wanted);

}  // namespace pent::simulator
