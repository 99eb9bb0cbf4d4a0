#pragma once

#include <pent/simplex_mesh.h>
#include <pent/simulator/ranks.h>

#include <cstdint>
#include <span>

namespace pent::simulator {

/// The mesh of a body as this process has it: the whole of it, or what ranks have of it, all
/// vertices and the NeededCells, see mesh_parts.h. What is asked of it all ranks ask together, and
/// all get the same answer.
template <int Dim>
struct MeshShare {
    const SimplexMesh<Dim>& mesh;
    std::span<const std::uint32_t> owners = {};  ///< The rank of each vertex; empty for a whole.
    const Ranks* ranks = nullptr;                ///< Null for a whole.

    [[nodiscard]] bool owns(std::uint32_t vertex) const {
        return ranks == nullptr || owners[vertex] == static_cast<std::uint32_t>(ranks->rank());
    }
};

}  // namespace pent::simulator
