#include "surface_readers.h"

#include <pent/counted.h>
#include <pent/error.h>
#include <pent/text_reader.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>

namespace pent::mesher {

namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");

constexpr std::size_t kHeader = 84;    // 80 bytes of text and the number of triangles
constexpr std::size_t kTriangle = 50;  // a normal, three points, two bytes of attributes

// The length that a binary file has by its header.
std::size_t binary_length(std::string_view bytes) {
    std::uint32_t triangles = 0;
    std::memcpy(&triangles, bytes.data() + kHeader - sizeof triangles, sizeof triangles);
    return kHeader + kTriangle * std::size_t{triangles};
}

// Binary files may start with "solid" as well: their length tells.
bool is_binary(std::string_view bytes) {
    return bytes.size() >= kHeader && bytes.size() == binary_length(bytes);
}

// A keyword, which some programs write in capitals.
std::string keyword_of(TextReader& text) {
    std::string word(text.word());
    for (char& c : word) {
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return word;
}

// Whether a file that has another length than its header says is binary nevertheless.
bool has_binary_header(TextReader text, std::string_view bytes) {
    return bytes.size() >= kHeader
           && (!text.next_line() || keyword_of(text) != "solid"
               || bytes.substr(0, kHeader).find('\0') != std::string_view::npos);
}

void add_last_triangle(SoupBuilder& builder) {
    const auto last = static_cast<std::uint32_t>(builder.point_count());
    builder.add_polygon(std::array{last - 3, last - 2, last - 1});
}

TriangleSoup read_binary(std::string_view bytes, const std::string& name) {
    SoupBuilder builder;
    for (std::size_t at = kHeader; at < bytes.size(); at += kTriangle) {
        std::array<float, 12> values{};
        std::memcpy(values.data(), bytes.data() + at, sizeof values);
        for (std::size_t i = 3; i < 12; i += 3) {
            const Eigen::Vector3d point(values[i], values[i + 1], values[i + 2]);
            if (!point.allFinite()) {
                throw Error(name + ": triangle " + std::to_string((at - kHeader) / kTriangle)
                            + ": a coordinate is not finite");
            }
            builder.add_point(point);
        }
        add_last_triangle(builder);
    }
    return builder.soup();
}

TriangleSoup read_text(TextReader& text) {
    if (!text.next_line() || keyword_of(text) != "solid") {
        text.fail("no \"solid\" at the start, and too short to be binary; expected an STL file");
    }
    SoupBuilder builder;
    std::int64_t corners = 0;  // of the loop that is open
    bool is_open = true;       // from solid to endsolid
    while (text.next_line()) {
        const std::string keyword = keyword_of(text);
        if (keyword == "vertex") {
            builder.add_point(text.point());
            ++corners;
        } else if (keyword == "endloop") {
            if (corners != 3) {
                text.fail("a loop of " + counted(corners, "vertex", "vertices") + "; expected 3");
            }
            add_last_triangle(builder);
            corners = 0;
        } else if (keyword == "solid" || keyword == "endsolid") {
            is_open = keyword == "solid";
        }
    }
    if (is_open) {
        text.fail("the file ends before \"endsolid\"; it may have been cut off, write it again");
    }
    return builder.soup();
}

}  // namespace

TriangleSoup read_stl(const std::filesystem::path& path) {
    TextReader text(path, '\0');
    const std::string_view bytes = text.rest();
    if (is_binary(bytes)) {
        return read_binary(bytes, text.name());
    }
    if (has_binary_header(text, bytes)) {
        const std::size_t length = binary_length(bytes);
        throw Error(text.name() + ": " + std::to_string(bytes.size()) + " bytes; expected "
                    + std::to_string(length) + " for the "
                    + counted((length - kHeader) / kTriangle, "triangle", "triangles")
                    + " that a binary STL file announces; it "
                    + (bytes.size() < length ? "may have been cut off" : "goes on behind them")
                    + ", write it again");
    }
    return read_text(text);
}

}  // namespace pent::mesher
