#pragma once

#include <pent/pent_file.h>
#include <pent/ply_elements.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace pent {

[[nodiscard]] std::size_t size_of(PlyType type);  ///< In bytes.
[[nodiscard]] std::string_view name_of(PlyType type);

/// Bytes of a line of a header, at most, without its end.
inline constexpr std::size_t kLongestLine = 4096;

/// The header of a .pent file, as parsed; not yet compared with the body.
struct Header {
    FileInfo info;
    bool has_checksum = false;
    std::string mesh_name;       ///< Of a frame.
    std::uint32_t mesh_crc = 0;  ///< Of a frame.
    std::uint64_t frame = 0;
    std::uint64_t step = 0;
    double time = 0;
    std::vector<PlyElement>
        elements;          ///< vertex first, then the cells (not in a frame), then others.
    std::size_t body = 0;  ///< Offset of the byte after end_header's newline.
};

/// Parses and checks the header at the start of `bytes`.
///
/// Throws an Error that names the file, the line, what was found and what was expected.
[[nodiscard]] Header parse_header(std::string_view bytes, const std::filesystem::path& path);

/// Throws an Error where the file is a frame.
void refuse_frame(const Header& header, const std::filesystem::path& path);

/// The text of a header up to and with end_header's newline.
[[nodiscard]] std::string format_header(const Header& header);

}  // namespace pent
