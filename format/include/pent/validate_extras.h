#pragma once

#include <pent/pent_file.h>

#include <string_view>

namespace pent {

/// Throws an Error that begins with `name` unless extras may stand beside a mesh in a file: as many
/// numbers as there are vertices, cells and facets, all finite and in range, and names of
/// quantities by which they are read again (see VertexField). write_mesh() requires this.
template <int Dim>
void validate_extras(const SimplexMesh<Dim>& mesh,
                     const MeshExtras<Dim>& extras,
                     std::string_view name);

}  // namespace pent
