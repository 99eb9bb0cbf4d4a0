#pragma once

#include <pent/mesher/solid.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace pent::mesher {

/// Whether the name ends as those of shape files do: .toml.
[[nodiscard]] bool is_shape_file(const std::filesystem::path& path);

/// Reads a solid from a shape file, see docs/shapes.md. Throws an Error with file:line:column for
/// what is not known or out of range.
[[nodiscard]] Solid read_solid(const std::filesystem::path& path);

/// The files of boundaries and images that a shape file names, as read_solid() opens them. Throws
/// an Error for a file that is no TOML.
[[nodiscard]] std::vector<std::filesystem::path> files_of_shapes(const std::filesystem::path& path);

/// The same as read_solid() from the text of a file.
/// @param name  Goes in front of messages.
[[nodiscard]] Solid parse_solid(std::string_view text, const std::string& name);

}  // namespace pent::mesher
