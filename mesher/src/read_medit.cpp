#include "tet_readers.h"
#include "text_reader.h"

#include <map>
#include <string>

namespace pent::mesher {

namespace {

// Whole numbers in a line of each section that is skipped.
const std::map<std::string_view, int>& skipped_sections() {
    static const std::map<std::string_view, int> sections = {{"Edges", 3},
                                                             {"Triangles", 4},
                                                             {"Quadrilaterals", 5},
                                                             {"Hexahedra", 9},
                                                             {"Corners", 1},
                                                             {"Ridges", 1},
                                                             {"RequiredVertices", 1},
                                                             {"RequiredEdges", 1},
                                                             {"RequiredTriangles", 1},
                                                             {"Prisms", 7},
                                                             {"Pyramids", 6},
                                                             {"Normals", 3},
                                                             {"NormalAtVertices", 2},
                                                             {"Tangents", 3},
                                                             {"TangentAtVertices", 2}};
    return sections;
}

double next_number(TextReader& text) {
    return text.number(text.next_word("a number"), "a number");
}

std::int64_t next_integer(TextReader& text) {
    return text.integer(text.next_word("a whole number"), "a whole number");
}

void read_vertices(TextReader& text, TetSoup& soup) {
    const std::int64_t count = text.count(text.next_word("a count"), "the number of vertices");
    for (std::int64_t i = 0; i < count; ++i) {
        Eigen::Vector3d point;
        for (double& coordinate : point) {
            coordinate = next_number(text);
        }
        static_cast<void>(next_number(text));  // a label
        soup.points.push_back(point);
    }
}

void read_cells(TextReader& text, TetSoup& soup) {
    const std::int64_t count = text.count(text.next_word("a count"), "the number of tetrahedra");
    for (std::int64_t i = 0; i < count; ++i) {
        std::array<std::uint32_t, 4> tet{};
        for (std::uint32_t& corner : tet) {
            corner =
                text.index(next_integer(text) - 1, static_cast<std::int64_t>(soup.points.size()));
        }
        soup.tets.push_back(tet);
        soup.labels.push_back(next_integer(text));
    }
}

}  // namespace

TetSoup read_medit(const std::filesystem::path& path) {
    TextReader text(path);
    if (!text.next_line() || text.word() != "MeshVersionFormatted") {
        text.fail("no MeshVersionFormatted at the start; expected a Medit file as text");
    }
    static_cast<void>(next_integer(text));
    TetSoup soup;
    while (true) {
        std::string_view keyword = text.word();
        if (keyword.empty()) {
            if (!text.next_line()) {
                return soup;
            }
            keyword = text.word();
        }
        const auto skipped = skipped_sections().find(keyword);
        if (keyword == "Dimension") {
            const std::int64_t dimension = next_integer(text);
            if (dimension != 3) {
                text.fail("dimension " + std::to_string(dimension) + "; expected 3");
            }
        } else if (keyword == "Vertices") {
            read_vertices(text, soup);
        } else if (keyword == "Tetrahedra") {
            read_cells(text, soup);
        } else if (skipped != skipped_sections().end()) {
            const std::int64_t count = text.count(text.next_word("a count"), "a count");
            for (std::int64_t i = 0; i < count * skipped->second; ++i) {
                static_cast<void>(text.next_word("a number"));
            }
        } else if (keyword == "End") {
            return soup;
        } else {
            text.fail("section \"" + std::string(keyword) + "\"; expected one of Medit's");
        }
    }
}

}  // namespace pent::mesher
