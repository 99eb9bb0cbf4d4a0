#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

namespace pent {

/// The bytes of a file, or of a part of it, in memory.
struct InputFile {
    std::unique_ptr<char[]> data;
    std::size_t bytes = 0;

    [[nodiscard]] std::string_view view() const { return {data.get(), bytes}; }
};

/// Reads a regular file, or `limit` bytes of it from `first` on. Throws an Error that names it when
/// it is missing, a folder, or cannot be read.
[[nodiscard]] InputFile read_input(const std::filesystem::path& path,
                                   std::size_t limit = static_cast<std::size_t>(-1),
                                   std::uint64_t first = 0);

}  // namespace pent
