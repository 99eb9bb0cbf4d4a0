#pragma once

#include <pent/simplex_mesh.h>
#include <pent/simulator/scene.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace pent::simulator {

// What select_vertices() and select_cells() are made of: for parts of meshes, of which one may have
// nothing where another has something.

/// Whether any of these selects by a region's label.
[[nodiscard]] bool selects_by_region(const std::vector<Selection>& select);

/// One entry a vertex: whether it is selected. A label selects the vertices of the cells that are
/// here.
///
/// @param where  Who selects, for messages. Throws an Error if it asks for layers that the mesh
///               does not know.
template <int Dim>
[[nodiscard]] std::vector<bool> mark_vertices(const SimplexMesh<Dim>& mesh,
                                              const std::vector<Selection>& select,
                                              const std::string& where);

/// The same of cells, as select_cells() selects them.
template <int Dim>
[[nodiscard]] std::vector<bool> mark_cells(const SimplexMesh<Dim>& mesh,
                                           const std::vector<Selection>& select,
                                           const std::string& where);

/// Of what every cell is, see materials_of_cells().
///
/// @param mark  Which cells a region has, one entry a cell.
[[nodiscard]] std::vector<std::uint16_t> materials_by_regions(
    std::size_t cells,
    const Body& body,
    const std::function<std::vector<bool>(const Region&)>& mark);

/// "the body as placed reaches from [0, 0] to [1, 1]".
template <int Dim>
[[nodiscard]] std::string extent_text(const Positions<Dim>& positions);

}  // namespace pent::simulator
