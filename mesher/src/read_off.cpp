#include "surface_readers.h"
#include "text_reader.h"

#include <string>
#include <vector>

namespace pent::mesher {

namespace {

void next_line(TextReader& text, const char* expected) {
    if (!text.next_line()) {
        text.fail(std::string("the file ends here; expected ") + expected);
    }
}

std::vector<std::uint32_t> read_polygon(TextReader& text, std::int64_t points) {
    const std::int64_t corners = text.integer(text.word(), "the number of corners of a face");
    if (corners < 3 || corners > text.size()) {
        text.fail("a face with " + std::to_string(corners) + " corners; expected 3 or more");
    }
    std::vector<std::uint32_t> polygon;
    for (std::int64_t i = 0; i < corners; ++i) {
        polygon.push_back(text.index(text.word(), points));
    }
    return polygon;
}

}  // namespace

TriangleSoup read_off(const std::filesystem::path& path) {
    TextReader text(path);
    next_line(text, "OFF");
    const std::string_view keyword = text.word();
    if (keyword.size() < 3 || keyword.substr(keyword.size() - 3) != "OFF") {
        text.fail("no OFF at the start; expected a file in OFF format");
    }
    std::string_view first = text.word();
    if (first.empty()) {
        next_line(text, "the numbers of points, faces and edges");
        first = text.word();
    } else if (first == "BINARY") {
        text.fail("binary OFF; expected text, convert it first");
    }
    const std::int64_t points = text.count(first, "the number of points");
    const std::int64_t faces = text.count(text.word(), "the number of faces");
    SoupBuilder builder;
    for (std::int64_t i = 0; i < points; ++i) {
        next_line(text, "a point");
        builder.add_point(text.point());
    }
    for (std::int64_t i = 0; i < faces; ++i) {
        next_line(text, "a face");
        builder.add_polygon(read_polygon(text, points));
    }
    return builder.soup();
}

}  // namespace pent::mesher
