#include "surface_readers.h"

#include <pent/counted.h>
#include <pent/text_reader.h>

#include <string>
#include <vector>

namespace pent::mesher {

namespace {

std::uint32_t read_corner(const TextReader& text, std::string_view word, std::int64_t points) {
    const std::int64_t index = text.integer(word.substr(0, word.find('/')), "a corner of a face");
    const std::int64_t from_zero = index < 0 ? points + index : index - 1;
    if (from_zero < 0 || from_zero >= points) {
        text.fail("corner " + std::to_string(index) + " of a face, but there are "
                  + std::to_string(points) + " points so far");
    }
    return static_cast<std::uint32_t>(from_zero);
}

std::vector<std::uint32_t> read_polygon(TextReader& text, std::int64_t points) {
    std::vector<std::uint32_t> polygon;
    for (std::string_view word = text.word(); !word.empty(); word = text.word()) {
        polygon.push_back(read_corner(text, word, points));
    }
    if (polygon.size() < 3) {
        text.fail("a face with " + counted(polygon.size(), "corner", "corners")
                  + "; expected 3 or more");
    }
    return polygon;
}

}  // namespace

TriangleSoup read_obj(const std::filesystem::path& path) {
    TextReader text(path);
    SoupBuilder builder;
    while (text.next_line()) {
        const std::string_view keyword = text.word();
        if (keyword == "v") {
            builder.add_point(text.point());
        } else if (keyword == "f") {
            builder.add_polygon(read_polygon(text, builder.point_count()));
        } else if (keyword == "l" || keyword == "p") {
            builder.leave_out(keyword == "l" ? CellKind::Line : CellKind::Point);
        } else if (keyword == "surf" || keyword == "bsp" || keyword == "bzp" || keyword == "cdp"
                   || keyword == "con") {
            text.fail("a free-form surface (" + std::string(keyword)
                      + "); expected polygons: write the file as a mesh");
        }
    }
    return builder.soup();
}

}  // namespace pent::mesher
