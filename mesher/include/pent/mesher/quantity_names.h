#pragma once

#include <pent/pent_file.h>
#include <pent/simplex_mesh.h>

#include <string>
#include <vector>

namespace pent::mesher {

/// What a mesh has beside its shape: quantities of vertices, of cells, and "fibers".
template <int Dim>
[[nodiscard]] std::vector<std::string> quantity_names(const SimplexMesh<Dim>& mesh,
                                                      const MeshExtras<Dim>& extras);

}  // namespace pent::mesher
