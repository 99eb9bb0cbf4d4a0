#pragma once

#include <pent/mesh_part.h>
#include <pent/pent_file.h>

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace pent {

/// What a file says beside its mesh of the rows of a slab, and of facets with the last cell: all of
/// them, which are fewer than cells, or none. Nothing, where the file has base and layers.
///
/// Reads these rows alone, but all of text. Not checked but for what a header has to have. Throws
/// an Error as read_mesh() does, or where the file has other rows than the slab is one of.
template <int Dim>
[[nodiscard]] MeshExtras<Dim> read_extras(const std::filesystem::path& path, const MeshSlab& slab);

/// Throws the Error of read_mesh() unless all of it is finite, and facets are of vertices.
///
/// @param vertices  Of the whole mesh.
template <int Dim>
void validate_extras(const MeshExtras<Dim>& extras,
                     const MeshSlab& slab,
                     Eigen::Index vertices,
                     std::string_view name);

}  // namespace pent
