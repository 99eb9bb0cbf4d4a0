#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace pent {

/// The name that stands for standard input.
inline constexpr std::string_view kStandardInput = "-";

/// The format of a file as the ending of a name, as in ".obj": in small letters, from its name
/// unless one is given ("obj").
[[nodiscard]] std::string format_of(const std::filesystem::path& path, const std::string& given);

/// What errors call a file: its path, or "standard input" for "-".
[[nodiscard]] std::string input_name(const std::filesystem::path& path);

/// Throws an Error if the path leads to a folder.
void refuse_folder(const std::filesystem::path& path);

/// Throws an Error unless the file is there, and no folder. Standard input is there.
void require_file(const std::filesystem::path& path);

}  // namespace pent
