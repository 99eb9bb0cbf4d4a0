#pragma once

#include "simulator_names.h"

#include <pent/facets.h>
#include <pent/pent_file.h>
#include <pent/runs/scene_meshes.h>
#include <pent/simplex_mesh.h>

#include <functional>
#include <string>
#include <vector>

namespace pent::runs {

// What read_meshes() checks of each body, which holds for bodies that are read in parts, too.

/// What the header of its file says. Throws an Error for another dimension.
template <int Dim>
[[nodiscard]] FileInfo info_of_mesh(const Body& body);

/// Turns vectors among quantities of a mesh with the body that is placed, as fibers do.
template <int Dim>
void turn(std::vector<VertexField>& fields, const simulator::Placement& placement);

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

}  // namespace pent::runs
