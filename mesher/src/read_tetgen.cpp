#include "tet_readers.h"

#include <pent/text_reader.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace pent::mesher {

namespace {

void next_line(TextReader& text, const char* expected) {
    if (!text.next_line()) {
        text.fail(std::string("the file ends here; expected ") + expected);
    }
}

// Points are numbered from 0 or 1: by the number of the first one.
std::int64_t read_nodes(TextReader& text, CellSoup& soup) {
    next_line(text, "the number of points");
    const std::int64_t points = text.count(text.word(), "the number of points");
    const std::int64_t dimension = text.integer(text.word(), "the dimension");
    if (dimension != 3) {
        text.fail("dimension " + std::to_string(dimension) + "; expected 3");
    }
    std::int64_t first = 0;
    for (std::int64_t i = 0; i < points; ++i) {
        next_line(text, "a point");
        const std::int64_t number = text.integer(text.word(), "the number of a point");
        if (i == 0) {
            first = number;
        }
        if (number != first + i || first < 0 || first > 1) {
            text.fail("point number " + std::to_string(number) + "; expected "
                      + std::to_string(i == 0 ? 0 : first + i) + (i == 0 ? " or 1" : ""));
        }
        soup.points.push_back(text.point());
    }
    return first;
}

// Regions are numbers, and attributes may be anything.
std::int64_t read_label(TextReader& text) {
    const std::string word(text.word());
    const double label = text.number(word, "an attribute");
    if (label != std::floor(label)) {
        text.fail("the attribute " + word
                  + "; expected a whole number, the region of the tetrahedron, or, on the first"
                    " line, that there are 0 attributes");
    }
    return static_cast<std::int64_t>(std::clamp(label, -1.0, 1e9));
}

void read_elements(TextReader& text, std::int64_t first, CellSoup& soup) {
    next_line(text, "the number of tetrahedra");
    const std::int64_t tets = text.count(text.word(), "the number of tetrahedra");
    const std::int64_t corners = text.integer(text.word(), "the number of corners");
    const std::string_view word = text.word();
    const std::int64_t attributes =
        word.empty() ? 0 : text.integer(word, "the number of attributes");
    if (corners != 4 && corners != 10) {
        text.fail(std::to_string(corners) + " corners; expected 4 or 10");
    }
    const auto points = static_cast<std::int64_t>(soup.points.size());
    std::vector<std::uint32_t> nodes(corners);  // those beyond the fourth are middles of edges
    soup.has_labels = attributes > 0;
    for (std::int64_t i = 0; i < tets; ++i) {
        next_line(text, "a tetrahedron");
        static_cast<void>(text.integer(text.word(), "the number of a tetrahedron"));
        for (std::uint32_t& node : nodes) {
            const std::int64_t number = text.integer(text.word(), "a corner");
            node = text.index(number - first, points);
        }
        soup.add(CellKind::Tetrahedron, nodes, attributes > 0 ? read_label(text) : 0);
    }
}

}  // namespace

CellSoup read_tetgen(const std::filesystem::path& path) {
    CellSoup soup;
    TextReader nodes(std::filesystem::path(path).replace_extension(".node"));
    const std::int64_t first = read_nodes(nodes, soup);
    TextReader elements(std::filesystem::path(path).replace_extension(".ele"));
    read_elements(elements, first, soup);
    return soup;
}

}  // namespace pent::mesher
