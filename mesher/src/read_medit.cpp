#include "tet_readers.h"

#include <pent/text_reader.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pent::mesher {

namespace {

// A section of numbers: what each of its lines is, if it is a cell, and how many whole numbers it
// has beside a label at the end.
struct Section {
    std::string_view name;
    std::optional<CellKind> kind;
    int numbers;
    bool has_label = true;
};

// In cells of higher order the corners come first.
constexpr std::array kSections = {
    Section{"Tetrahedra", CellKind::Tetrahedron, 4},
    Section{"Pyramids", CellKind::Pyramid, 5},
    Section{"Prisms", CellKind::Prism, 6},
    Section{"Pentahedra", CellKind::Prism, 6},
    Section{"Hexahedra", CellKind::Hexahedron, 8},
    Section{"TetrahedraP2", CellKind::Tetrahedron, 10},
    Section{"PyramidsP2", CellKind::Pyramid, 14},
    Section{"PrismsP2", CellKind::Prism, 18},
    Section{"HexahedraQ2", CellKind::Hexahedron, 27},
    Section{"Triangles", CellKind::Triangle, 3},
    Section{"TrianglesP2", CellKind::Triangle, 6},
    Section{"Quadrilaterals", CellKind::Quadrilateral, 4},
    Section{"QuadrilateralsQ2", CellKind::Quadrilateral, 9},
    Section{"Edges", CellKind::Line, 2},
    Section{"EdgesP2", CellKind::Line, 3},
    Section{"Corners", std::nullopt, 1, false},
    Section{"Ridges", std::nullopt, 1, false},
    Section{"RequiredVertices", std::nullopt, 1, false},
    Section{"RequiredEdges", std::nullopt, 1, false},
    Section{"RequiredTriangles", std::nullopt, 1, false},
    Section{"RequiredQuadrilaterals", std::nullopt, 1, false},
    Section{"RequiredTetrahedra", std::nullopt, 1, false},
    Section{"Normals", std::nullopt, 3, false},
    Section{"NormalAtVertices", std::nullopt, 2, false},
    Section{"Tangents", std::nullopt, 3, false},
    Section{"TangentAtVertices", std::nullopt, 2, false},
};

const Section* find_section(std::string_view name) {
    for (const Section& section : kSections) {
        if (section.name == name) {
            return &section;
        }
    }
    return nullptr;
}

double next_number(TextReader& text) {
    return text.number(text.next_word("a number"), "a number");
}

std::int64_t next_integer(TextReader& text) {
    return text.integer(text.next_word("a whole number"), "a whole number");
}

// @param labels  Gets that of each, which is 0 for none.
void read_vertices(TextReader& text, CellSoup& soup, std::vector<double>& labels) {
    const std::int64_t count = text.count(text.next_word("a count"), "the number of vertices");
    for (std::int64_t i = 0; i < count; ++i) {
        Eigen::Vector3d point;
        for (double& coordinate : point) {
            coordinate = next_number(text);
        }
        labels.push_back(next_number(text));
        soup.points.push_back(point);
    }
}

void read_section(TextReader& text, const Section& section, CellSoup& soup) {
    const std::int64_t count = text.count(text.next_word("a count"), "a count");
    const bool is_read = section.kind && dimension_of(*section.kind) == 3;
    std::vector<std::uint32_t> nodes(section.numbers, 0);
    for (std::int64_t i = 0; i < count; ++i) {
        for (std::uint32_t& node : nodes) {
            if (is_read) {
                node = text.index(next_integer(text) - 1,
                                  static_cast<std::int64_t>(soup.points.size()));
            } else {
                static_cast<void>(text.next_word("a number"));
            }
        }
        const std::int64_t label = section.has_label ? next_integer(text) : 0;
        if (section.kind) {
            soup.add(*section.kind, nodes, label);
        }
    }
}

// All sections up to the end.
void read_sections(TextReader& text, CellSoup& soup, std::vector<double>& vertex_labels) {
    while (true) {
        std::string_view keyword = text.word();
        if (keyword.empty()) {
            if (!text.next_line()) {
                return;
            }
            keyword = text.word();
        }
        if (keyword == "Dimension") {
            const std::int64_t dimension = next_integer(text);
            if (dimension != 3) {
                text.fail("dimension " + std::to_string(dimension) + "; expected 3");
            }
        } else if (keyword == "Vertices") {
            read_vertices(text, soup, vertex_labels);
        } else if (const Section* section = find_section(keyword)) {
            read_section(text, *section, soup);
        } else if (keyword == "End") {
            return;
        } else {
            text.fail("section \"" + std::string(keyword) + "\"; expected one of Medit's");
        }
    }
}

}  // namespace

FileGrid read_medit(const std::filesystem::path& path) {
    TextReader text(path);
    if (!text.next_line() || text.word() != "MeshVersionFormatted") {
        text.fail("no MeshVersionFormatted at the start; expected a Medit file as text");
    }
    static_cast<void>(next_integer(text));
    FileGrid grid;
    grid.soup.has_labels = true;
    FileArray labels{"vertex_label", 1, {}};
    read_sections(text, grid.soup, labels.values);
    if (std::any_of(labels.values.begin(), labels.values.end(),
                    [](double label) { return label != 0; })) {
        grid.point_arrays.push_back(std::move(labels));
    }
    return grid;
}

}  // namespace pent::mesher
