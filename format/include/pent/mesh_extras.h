#pragma once

#include <pent/mesh_part.h>
#include <pent/pent_file.h>

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace pent {

/// The extras of the rows of a slab. Labeled facets, which are fewer than cells, are not divided:
/// the slab with the last cell has all of them. Nothing where the file has base and layers.
///
/// Reads these rows alone; of a text file all rows. Only the header is checked, see
/// validate_extras(). Throws an Error as read_mesh() does, or if the slab cannot be one of this
/// file, which was replaced then.
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
