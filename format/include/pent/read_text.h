#pragma once

#include <filesystem>
#include <string>

namespace pent {

/// All bytes of a file or a pipe. Throws an Error that names it and says what was expected, as in
/// "a scene file (TOML)", if it is not there, is a folder or cannot be read.
[[nodiscard]] std::string read_text(const std::filesystem::path& path, const std::string& expected);

}  // namespace pent
