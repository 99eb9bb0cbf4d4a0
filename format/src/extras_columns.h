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

/// The columns that a file has for the extras of vertices; and all columns of vertices, those of
/// the mesh first.
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

/// The columns of the facets with labels.
template <int Dim>
[[nodiscard]] std::vector<Column> boundary_columns(const MeshExtras<Dim>& extras);

/// The element of these facets; null if the file has none, or one with lists.
[[nodiscard]] const PlyElement* boundary_of(const Header& header);

/// Extras with room for what a file has of them. Throws an Error for properties of wrong types.
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
