#pragma once

#include "body.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace pent {

/// The header of a file, of which no more is read than a header may be long.
[[nodiscard]] Header read_header(const std::filesystem::path& path);

/// Bytes of a row in a binary file, of an element without lists.
[[nodiscard]] std::size_t row_bytes(const PlyElement& element);

/// Where rows of one element are in a file.
struct RowBytes {
    std::uint64_t first = 0;
    std::uint64_t last = 0;      ///< Behind them.
    std::uint64_t in_front = 0;  ///< Rows of the element.
};

/// Reads them alone, as if they were a file.
///
/// @param rows  The element, with so many rows as there are.
void read_rows(const std::filesystem::path& path,
               Encoding encoding,
               const RowBytes& bytes,
               const PlyElement& rows,
               const std::vector<Column>& columns);

}  // namespace pent
