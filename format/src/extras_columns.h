#pragma once

#include "mesh_columns.h"

#include <pent/mesh_part.h>
#include <pent/pent_file.h>

#include <filesystem>
#include <string_view>
#include <vector>

namespace pent {

inline constexpr const char* kBisectionTag = "bisection_tag";
inline constexpr const char* kBoundary = "boundary";

/// Prefixes of the vectors of cells that are no fields.
inline const std::vector<std::string_view> kCellVectors = {"fiber_"};

/// What a file has of vertices beside the mesh, and behind what it has of that.
template <int Dim>
[[nodiscard]] std::vector<Column> vertex_columns(const MeshExtras<Dim>& extras);
template <int Dim>
[[nodiscard]] std::vector<Column> vertex_columns(const SimplexMesh<Dim>& mesh,
                                                 const MeshExtras<Dim>& extras);

/// The same of cells.
template <int Dim>
[[nodiscard]] std::vector<Column> cell_columns(const MeshExtras<Dim>& extras);
template <int Dim>
[[nodiscard]] std::vector<Column> cell_columns(const SimplexMesh<Dim>& mesh,
                                               const MeshExtras<Dim>& extras);

/// What it has of the facets with labels.
template <int Dim>
[[nodiscard]] std::vector<Column> boundary_columns(const MeshExtras<Dim>& extras);

/// Those facets, if a file has an element with what they need; or null.
[[nodiscard]] const PlyElement* boundary_of(const Header& header);

/// Room for what a file has beside the mesh. Throws an Error for properties of other types.
template <int Dim>
[[nodiscard]] MeshExtras<Dim> sized_extras(const Header& header, const std::filesystem::path& path);

/// Checks counts, indices and numbers of what is beside the rows of a slab.
///
/// @param vertices  Of the whole mesh.
template <int Dim>
void check_extras(const MeshExtras<Dim>& extras,
                  const MeshSlab& slab,
                  Eigen::Index vertices,
                  const std::filesystem::path& path);

}  // namespace pent
