#pragma once

#include "simulator_names.h"

#include <pent/facets.h>
#include <pent/pent_file.h>
#include <pent/simplex_mesh.h>

#include <functional>
#include <string>
#include <vector>

namespace pent::runs {

/// The meshes of a scene, one a body, as their files have them.
template <int Dim>
struct SceneMeshes {
    std::vector<SimplexMesh<Dim>> meshes;
    std::vector<std::string> warnings;  ///< What pent-check would refuse of them, a line each.
};

/// Reads them as a whole, for a program on its own, and compares them with the scene. Ranks have
/// read_parts().
///
/// Throws an Error that begins with the place in the scene file if one cannot be read, is of
/// another dimension, is placed so small or large that its volumes leave the range of double, has
/// cells that do not fit together where contact needs a closed surface, or if a constraint selects
/// nothing or what another holds at that time.
template <int Dim>
[[nodiscard]] SceneMeshes<Dim> read_meshes(const Scene& scene);

// What it checks of each body, which holds for bodies that are read in parts, too.

/// What the header of its file says. Throws an Error for another dimension.
template <int Dim>
[[nodiscard]] FileInfo info_of_mesh(const Body& body);

/// Does work whose Errors do not know where in the scene file the body is: then they say so.
void with_place_of(const Body& body, const std::function<void()>& work);

/// Throws an Error where the body is placed so small or large that volumes leave the range.
template <int Dim>
void check_size(const SimplexMesh<Dim>& mesh, const Body& body);

/// Adds a warning where the cells of a mesh do not fit together, or throws an Error where contact
/// needs a closed surface.
///
/// @param facets  Of the whole mesh; boundaries do not count.
template <int Dim>
void judge_facets(const Scene& scene,
                  const Body& body,
                  const FacetMatch<Dim>& facets,
                  std::vector<std::string>& warnings);

/// Throws an Error where a vertex of a body is held by two constraints at one time.
///
/// @param mesh  As its file has it.
template <int Dim>
void check_constraints(const Scene& scene, const Body& body, const SimplexMesh<Dim>& mesh);

}  // namespace pent::runs
