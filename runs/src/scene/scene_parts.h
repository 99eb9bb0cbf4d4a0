#pragma once

#include "run/run_ranks.h"
#include "simulator_names.h"

#include <pent/mesh_part.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pent::runs {

/// The meshes of a scene, of which this rank has all vertices and the cells that it needs.
template <int Dim>
struct SceneParts {
    std::vector<MeshPart<Dim>> parts;      ///< One a body, as their files have them.
    std::vector<MeshSource<Dim>> sources;  ///< One a body, to read other parts from.
    std::vector<std::uint32_t> owners;     ///< The rank of each vertex, of all bodies.
    std::vector<std::string> warnings;     ///< As of SceneMeshes.
};

/// Reads them together and compares them with the scene, as read_meshes() does, with the same
/// Errors and warnings: a file by slabs, which all ranks see go by; of base and layers each makes
/// what it needs.
///
/// @param ranks  At least one.
template <int Dim>
[[nodiscard]] SceneParts<Dim> read_parts(const Scene& scene, const RunRanks& ranks);

}  // namespace pent::runs
