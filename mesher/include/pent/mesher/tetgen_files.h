#pragma once

#include <filesystem>

namespace pent::mesher {

/// The other of the two files of a mesh of TetGen: .ele of .node and .node of .ele, in capitals if
/// the ending is; an empty path for files of other formats.
[[nodiscard]] std::filesystem::path other_tetgen_file(const std::filesystem::path& path);

}  // namespace pent::mesher
