#pragma once

#include <pent/pent_file.h>
#include <pent/simplex_mesh.h>

#include <string>
#include <vector>

namespace pent::mesher {

/// The names of all quantities of a mesh: those of vertices, those of cells, and "fibers".
template <int Dim>
[[nodiscard]] std::vector<std::string> quantity_names(const SimplexMesh<Dim>& mesh,
                                                      const MeshExtras<Dim>& extras);

}  // namespace pent::mesher
