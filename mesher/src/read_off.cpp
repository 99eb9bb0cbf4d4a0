#include "surface_readers.h"

#include <pent/text_reader.h>

#include <string>
#include <vector>

namespace pent::mesher {

namespace {

void next_line(TextReader& text, const char* expected) {
    if (!text.next_line()) {
        text.fail(std::string("the file ends here; expected ") + expected);
    }
}

// A face of two corners is a line, one of one a point.
void read_face(TextReader& text, std::int64_t points, SoupBuilder& builder) {
    const std::int64_t corners = text.integer(text.word(), "the number of corners of a face");
    if (corners < 1 || corners > text.size()) {
        text.fail("a face with " + std::to_string(corners) + " corners; expected 1 or more");
    }
    std::vector<std::uint32_t> polygon;
    for (std::int64_t i = 0; i < corners; ++i) {
        polygon.push_back(text.index(text.word(), points));
    }
    if (corners < 3) {
        builder.leave_out(corners == 2 ? CellKind::Line : CellKind::Point);
    } else {
        builder.add_polygon(polygon);
    }
}

// The keyword is OFF behind letters for what each line of a point has: texture (ST), color (C),
// normal (N), which all stand behind its coordinates; but 4 and n say that there are more
// coordinates than three.
void check_keyword(const TextReader& text, std::string_view keyword) {
    if (!keyword.ends_with("OFF")) {
        text.fail("no OFF at the start; expected a file in OFF format");
    }
    std::string_view letters = keyword.substr(0, keyword.size() - 3);
    for (const std::string_view known : {"ST", "C", "N"}) {
        letters.remove_prefix(letters.starts_with(known) ? known.size() : 0);
    }
    if (letters == "4" || letters == "n" || letters == "4n") {
        text.fail(std::string(keyword)
                  + ": points that have not three coordinates; expected OFF, COFF, NOFF or STOFF,"
                    " in space");
    }
    if (!letters.empty()) {
        text.fail("no OFF at the start; expected a file in OFF format");
    }
}

}  // namespace

TriangleSoup read_off(const std::filesystem::path& path) {
    TextReader text(path);
    next_line(text, "OFF");
    const std::string_view keyword = text.word();
    check_keyword(text, keyword);
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
        read_face(text, points, builder);
    }
    return builder.soup();
}

}  // namespace pent::mesher
