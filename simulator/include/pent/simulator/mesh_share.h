#pragma once

#include <pent/simplex_mesh.h>
#include <pent/simulator/ranks.h>
#include <pent/simulator/selection.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace pent::simulator {

/// The mesh of a body as this process has it: the whole of it, or the part of a rank, all vertices
/// and the NeededCells, see mesh_parts.h. Functions of it are collective: all ranks call them, and
/// all get the same answer.
template <int Dim>
struct MeshShare {
    const SimplexMesh<Dim>& mesh;
    std::span<const std::uint32_t> owners = {};  ///< Of each vertex, a rank; empty for a whole.
    const Ranks* ranks = nullptr;                ///< Null for a whole.

    [[nodiscard]] bool owns(std::uint32_t vertex) const {
        return ranks == nullptr || owners[vertex] == static_cast<std::uint32_t>(ranks->rank());
    }
};

/// How deep a mesh is under its boundary.
struct MeshDepth {
    std::int64_t boundary_vertices = 0;

    /// How many cells the thickest part is across, or one less: twice the number of edges from its
    /// innermost vertex to the boundary; 1 where every vertex is on the boundary.
    ///
    /// Linear simplices bend too little: the fewer cells across, the less.
    int cells_across = 1;
};

template <int Dim>
[[nodiscard]] MeshDepth depth_of(const MeshShare<Dim>& share);

/// How many vertices of a placed mesh are selected by any of these; labels of regions are those of
/// the cells that are here.
///
/// @param where  Who selects, for messages. Throws an Error if it asks for layers that the mesh
///               does not know.
template <int Dim>
[[nodiscard]] std::int64_t count_selected(const MeshShare<Dim>& share,
                                          const std::vector<Selection>& select,
                                          const std::string& where);

}  // namespace pent::simulator
