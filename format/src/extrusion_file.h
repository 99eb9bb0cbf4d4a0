#pragma once

#include "header.h"

#include <pent/extrusion.h>

#include <filesystem>
#include <string_view>

namespace pent {

/// Whether a file holds base and layers in place of a mesh.
[[nodiscard]] bool is_extrusion(const Header& header);

/// What a header says of the mesh that the file's base and layers make.
///
/// @param file  All of it.
[[nodiscard]] FileInfo info_of_extrusion(const Header& header,
                                         std::string_view file,
                                         const std::filesystem::path& path);

/// Base and layers of a file that holds them, checked as read_extrusion() says.
template <int Dim>
[[nodiscard]] Extrusion<Dim> parse_extrusion(const Header& header,
                                             std::string_view file,
                                             const std::filesystem::path& path);

/// What is to be said of the mesh that they make. Throws an Error if its vertices and a part of its
/// cells are more than can be numbered, or than this machine has memory for: a file of some
/// megabytes may ask for any number.
///
/// @param parts  1 for all of its cells.
template <int Dim>
[[nodiscard]] FileInfo info_in_memory(const Header& header,
                                      const Extrusion<Dim>& extrusion,
                                      int parts,
                                      const std::filesystem::path& path);

/// The mesh that they make, checked as read_mesh() says.
template <int Dim>
[[nodiscard]] MeshFile<Dim> extrude_file(const Header& header,
                                         std::string_view file,
                                         const std::filesystem::path& path);

}  // namespace pent
