#pragma once

#include "body.h"

#include <pent/simplex_mesh.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace pent {

/// The property of cells that has SimplexMesh::parents.
inline constexpr const char* kParent = "parent";

template <typename Value>
[[nodiscard]] Column array_column(std::string name,
                                  PlyType type,
                                  const std::vector<Value>& values) {
    auto* data = const_cast<Value*>(values.data());  // as in row_column
    return {std::move(name), type, reinterpret_cast<char*>(data), sizeof(Value)};
}

/// The columns of a file for the vertices of a mesh.
template <int Dim>
[[nodiscard]] std::vector<Column> vertex_columns(const SimplexMesh<Dim>& mesh);

/// The same for its cells.
template <int Dim>
[[nodiscard]] std::vector<Column> cell_columns(const SimplexMesh<Dim>& mesh);

/// Makes room in a mesh for what the element of vertices in a file has.
template <int Dim>
void size_vertices(const PlyElement& vertex,
                   const std::filesystem::path& path,
                   SimplexMesh<Dim>& mesh);

/// The same of cells.
template <int Dim>
void size_cells(const PlyElement& cell, const std::filesystem::path& path, SimplexMesh<Dim>& mesh);

}  // namespace pent
