#pragma once

#include "model/bodies.h"

#include <pent/simulator/ranks.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pent::simulator {

/// select_cells() of the cells, or the elements, that a rank has of a placed mesh. Throws an Error
/// on all ranks, as select_cells() of the whole does, where none is selected on any of them.
///
/// @param part     All vertices, and cells of this rank.
/// @param numbers  What each cell is called in the whole mesh; empty if as they come.
/// @param ranks    Null for none.
template <int Dim>
[[nodiscard]] std::vector<bool> select_cells(const SimplexMesh<Dim>& part,
                                             const std::vector<std::uint32_t>& numbers,
                                             const std::vector<Selection>& select,
                                             const std::string& where,
                                             const Ranks* ranks);

/// materials_of_cells() of the same.
template <int Dim>
[[nodiscard]] std::vector<std::uint16_t> materials_of_part(
    const SimplexMesh<Dim>& part,
    const std::vector<std::uint32_t>& numbers,
    const Body& body,
    const Ranks* ranks);

/// Vertices that are selected of a body, of its mesh, increasing, on all ranks alike, whether they
/// have whole meshes or parts. Throws an Error as select_vertices() of a mesh does.
///
/// @param where  Who selects, for messages.
template <int Dim>
[[nodiscard]] std::vector<std::uint32_t> select_vertices(const Bodies<Dim>& bodies,
                                                         std::size_t body,
                                                         const std::vector<Selection>& select,
                                                         const std::string& where);

}  // namespace pent::simulator
