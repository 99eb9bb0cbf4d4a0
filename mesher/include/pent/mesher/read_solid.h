#pragma once

#include <pent/mesher/solid.h>

#include <filesystem>
#include <string_view>

namespace pent::mesher {

/// Whether the name ends as those of shape files do: .toml.
[[nodiscard]] bool is_shape_file(const std::filesystem::path& path);

/// Reads a solid from a shape file, see docs/shapes.md. Throws an Error with file:line:column for
/// what is not known or out of range.
[[nodiscard]] Solid read_solid(const std::filesystem::path& path);

/// The same from the text of a file.
/// @param name  Goes in front of messages.
[[nodiscard]] Solid parse_solid(std::string_view text, const std::string& name);

}  // namespace pent::mesher
