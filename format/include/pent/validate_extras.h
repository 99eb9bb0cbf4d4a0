#pragma once

#include <pent/pent_file.h>

#include <string_view>

namespace pent {

/// Throws an Error that begins with `name` unless a file may say so of the mesh beside it: as many
/// numbers as it has vertices, cells and facets, all finite and in range, and quantities with names
/// that are read as what they are (see VertexField). write_mesh() asks for no less.
template <int Dim>
void validate_extras(const SimplexMesh<Dim>& mesh,
                     const MeshExtras<Dim>& extras,
                     std::string_view name);

}  // namespace pent
