#pragma once

#include "simulator_names.h"

#include <pent/simplex_mesh.h>

#include <string>
#include <vector>

namespace pent::runs {

/// The meshes of a scene, one a body, as their files have them.
template <int Dim>
struct SceneMeshes {
    std::vector<SimplexMesh<Dim>> meshes;
    std::vector<std::string> warnings;  ///< What pent-check would refuse of them, a line each.
};

/// Reads them and compares them with the scene.
///
/// Throws an Error that begins with the place in the scene file if one cannot be read, is of
/// another dimension, is placed so small or large that its volumes leave the range of double, has
/// cells that do not fit together where contact needs a closed surface, or if a constraint selects
/// nothing or what another holds at that time.
template <int Dim>
[[nodiscard]] SceneMeshes<Dim> read_meshes(const Scene& scene);

}  // namespace pent::runs
