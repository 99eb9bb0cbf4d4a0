#pragma once

#include "body.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace pent {

/// The header of a file; reads no more than the longest header may have.
[[nodiscard]] Header read_header(const std::filesystem::path& path);

/// Bytes of a row in a binary file, of an element without lists.
[[nodiscard]] std::size_t row_bytes(const PlyElement& element);

/// Where some rows of an element are in a file, in bytes from its beginning.
struct RowBytes {
    std::uint64_t first = 0;
    std::uint64_t last = 0;      ///< Behind the last one.
    std::uint64_t in_front = 0;  ///< How many rows of the element lie in front of these.
};

/// Reads these rows alone.
///
/// @param rows  The element with its count set to the number of these rows.
void read_rows(const std::filesystem::path& path,
               Encoding encoding,
               const RowBytes& bytes,
               const PlyElement& rows,
               const std::vector<Column>& columns);

}  // namespace pent
