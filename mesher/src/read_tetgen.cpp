#include "number_reader.h"
#include "tet_readers.h"

#include <pent/counted.h>
#include <pent/input_path.h>
#include <pent/mesher/tetgen_files.h>
#include <pent/text_reader.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace pent::mesher {

namespace {

constexpr const char* kNodes = ".node";
constexpr const char* kElements = ".ele";

void next_line(TextReader& text, const char* expected) {
    if (!text.next_line()) {
        text.fail(std::string("the file ends here; expected ") + expected);
    }
}

// How many of something a first line says; it may end before.
std::int64_t optional_count(TextReader& text, std::string_view expected) {
    const std::string_view word = text.word();
    return word.empty() ? 0 : text.count(word, expected);
}

// The attributes of a point or a tetrahedron, from the `first` one on. Arrays are made as the words
// of the first line are read, so that a count that is damaged takes no memory.
void read_attributes(TextReader& text,
                     const std::string& name,
                     std::int64_t first,
                     std::int64_t count,
                     bool is_first_line,
                     std::vector<FileArray>& arrays) {
    for (std::int64_t i = first; i <= count; ++i) {
        const double value = any_number(text, text.word(), "an attribute");
        if (is_first_line) {
            arrays.push_back({name + std::to_string(i), 1, {}});
        }
        arrays[static_cast<std::size_t>(i - first)].values.push_back(value);
    }
}

// Points are numbered from 0 or 1: by the number of the first one.
std::int64_t read_nodes(TextReader& text, FileGrid& grid) {
    next_line(text, "the number of points");
    const std::int64_t points = text.count(text.word(), "the number of points");
    const std::int64_t dimension = text.integer(text.word(), "the dimension");
    if (dimension != 3) {
        text.fail("dimension " + std::to_string(dimension) + "; expected 3");
    }
    const std::int64_t attributes = optional_count(text, "the number of attributes");
    const bool has_markers = optional_count(text, "0 or 1 boundary markers") > 0;
    FileArray markers{"boundary_marker", 1, {}};
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
        grid.soup.points.push_back(text.point());
        read_attributes(text, "attribute", 1, attributes, i == 0, grid.point_arrays);
        if (has_markers) {
            markers.values.push_back(any_number(text, text.word(), "a boundary marker"));
        }
    }
    if (has_markers) {
        grid.point_arrays.push_back(std::move(markers));
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

void read_elements(TextReader& text, std::int64_t first, FileGrid& grid) {
    next_line(text, "the number of tetrahedra");
    const std::int64_t tets = text.count(text.word(), "the number of tetrahedra");
    const std::int64_t corners = text.integer(text.word(), "the number of corners");
    const std::int64_t attributes = optional_count(text, "the number of attributes");
    if (corners != 4 && corners != 10) {
        text.fail(counted(corners, "corner", "corners") + "; expected 4 or 10");
    }
    CellSoup& soup = grid.soup;
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
        // The first is the region.
        read_attributes(text, "region_attribute", 2, attributes, i == 0, grid.cell_arrays);
    }
}

}  // namespace

std::filesystem::path other_tetgen_file(const std::filesystem::path& path) {
    const std::string ending = format_of(path, "");
    if (ending != kNodes && ending != kElements) {
        return {};
    }
    std::string other = ending == kNodes ? kElements : kNodes;
    if (path.extension().string() != ending) {
        std::transform(other.begin(), other.end(), other.begin(),
                       [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    }
    return std::filesystem::path(path).replace_extension(other);
}

FileGrid read_tetgen(const std::filesystem::path& path) {
    const std::filesystem::path other = other_tetgen_file(path);
    const bool has_nodes = format_of(path, "") == kNodes;
    FileGrid grid;
    TextReader nodes(has_nodes ? path : other);
    const std::int64_t first = read_nodes(nodes, grid);
    TextReader elements(has_nodes ? other : path);
    read_elements(elements, first, grid);
    return grid;
}

}  // namespace pent::mesher
