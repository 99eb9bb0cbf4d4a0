#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace pent::test {

/// All of a file.
[[nodiscard]] inline std::string bytes_of(const std::filesystem::path& path) {
    std::ostringstream bytes;
    bytes << std::ifstream(path, std::ios::binary).rdbuf();
    return bytes.str();
}

}  // namespace pent::test
