#pragma once

#include <pent/simplex_mesh.h>
#include <pent/simulator/scene.h>

#include <string>
#include <vector>

namespace pent::runs {

/// The meshes of a scene, one a body, as their files have them.
template <int Dim>
struct SceneMeshes {
    std::vector<SimplexMesh<Dim>> meshes;
    std::vector<std::string> warnings;  ///< What pent-check would refuse of them, a line each.
};

/// Reads them as a whole, for a program on its own, and compares them with the scene.
///
/// Throws an Error that begins with the place in the scene file if one cannot be read, is of
/// another dimension, or is none that judge_mesh() lets pass.
template <int Dim>
[[nodiscard]] SceneMeshes<Dim> read_meshes(const simulator::Scene& scene);

/// Compares a mesh, wherever it comes from, with the scene. Throws an Error if it is placed so
/// small or large that its volumes leave the range of double, or if its cells do not fit together
/// where contact needs a closed surface; adds a warning if they do not and nothing needs one.
///
/// @param mesh  One that validate() lets pass, before it is placed.
template <int Dim>
void judge_mesh(const simulator::Scene& scene,
                const simulator::Body& body,
                const SimplexMesh<Dim>& mesh,
                std::vector<std::string>& warnings);

}  // namespace pent::runs
