#include "tet_readers.h"
#include "text_reader.h"

#include <algorithm>
#include <string>

namespace pent::mesher {

namespace {

constexpr std::int64_t kTetrahedron = 10;  // VTK_TETRA
constexpr std::int64_t kQuadraticTetrahedron = 24;

std::int64_t next_integer(TextReader& text) {
    return text.integer(text.next_word("a whole number"), "a whole number");
}

std::int64_t next_count(TextReader& text) {
    return text.count(text.next_word("a count"), "a count");
}

void read_points(TextReader& text, TetSoup& soup) {
    const std::int64_t count = next_count(text);
    static_cast<void>(text.next_word("a type"));
    for (std::int64_t i = 0; i < count; ++i) {
        Eigen::Vector3d point;
        for (double& coordinate : point) {
            coordinate = text.number(text.next_word("a coordinate"), "a coordinate");
        }
        soup.points.push_back(point);
    }
}

// The corners of each cell, whatever its type.
using Cells = std::vector<std::vector<std::int64_t>>;

// Files up to version 4: the number of corners before each cell.
Cells read_cells_with_sizes(TextReader& text, std::int64_t count) {
    Cells cells(count);
    for (std::vector<std::int64_t>& cell : cells) {
        const std::int64_t size = next_count(text);
        for (std::int64_t i = 0; i < size; ++i) {
            cell.push_back(next_integer(text));
        }
    }
    return cells;
}

// Files from version 5 on: where each cell begins, then all corners.
Cells read_cells_with_offsets(TextReader& text, std::int64_t offsets, std::int64_t corners) {
    static_cast<void>(text.next_word("a type"));
    std::vector<std::int64_t> first;
    for (std::int64_t i = 0; i < offsets; ++i) {
        first.push_back(next_integer(text));
        if (first.back() < (i == 0 ? 0 : first[i - 1]) || first.back() > corners) {
            text.fail("offset " + std::to_string(first.back()) + " of " + std::to_string(corners));
        }
    }
    static_cast<void>(text.next_word("CONNECTIVITY"));
    static_cast<void>(text.next_word("a type"));
    std::vector<std::int64_t> all;
    for (std::int64_t i = 0; i < corners; ++i) {
        all.push_back(next_integer(text));
    }
    Cells cells;
    for (std::size_t i = 1; i < first.size(); ++i) {
        cells.emplace_back(all.begin() + first[i - 1], all.begin() + first[i]);
    }
    return cells;
}

Cells read_cells(TextReader& text) {
    const std::int64_t count = next_count(text);
    const std::int64_t size = next_count(text);
    text.skip_line();
    if (!text.next_line()) {
        text.fail("the file ends here; expected cells");
    }
    if (text.starts_with("OFFSETS")) {
        static_cast<void>(text.word());
        return read_cells_with_offsets(text, count, size);
    }
    return read_cells_with_sizes(text, count);
}

void read_types(TextReader& text, const Cells& cells, TetSoup& soup) {
    const std::int64_t count = next_count(text);
    if (count != static_cast<std::int64_t>(cells.size())) {
        text.fail(std::to_string(count) + " types of " + std::to_string(cells.size()) + " cells");
    }
    for (const std::vector<std::int64_t>& cell : cells) {
        const std::int64_t type = next_integer(text);
        if (type != kTetrahedron && type != kQuadraticTetrahedron) {
            continue;
        }
        if (cell.size() < 4) {
            text.fail("a tetrahedron with " + std::to_string(cell.size()) + " corners");
        }
        std::array<std::uint32_t, 4> tet{};
        for (int i = 0; i < 4; ++i) {
            tet[i] = text.index(cell[i], static_cast<std::int64_t>(soup.points.size()));
        }
        soup.tets.push_back(tet);
    }
}

}  // namespace

TetSoup read_vtk(const std::filesystem::path& path) {
    TextReader text(path, '\0');
    if (!text.next_line() || text.word() != "#") {
        text.fail("no \"# vtk DataFile\" at the start; expected a legacy VTK file");
    }
    TetSoup soup;
    Cells cells;
    bool is_title = true;
    while (text.next_line()) {
        const std::string_view keyword = is_title ? std::string_view() : text.word();
        is_title = false;
        if (keyword == "BINARY") {
            text.fail("a binary VTK file; expected ASCII");
        } else if (keyword == "DATASET") {
            const std::string_view kind = text.word();
            if (kind != "UNSTRUCTURED_GRID") {
                text.fail("dataset " + std::string(kind) + "; expected UNSTRUCTURED_GRID");
            }
        } else if (keyword == "POINTS") {
            read_points(text, soup);
        } else if (keyword == "CELLS") {
            cells = read_cells(text);
        } else if (keyword == "CELL_TYPES") {
            read_types(text, cells, soup);
        } else if (keyword == "POINT_DATA" || keyword == "CELL_DATA") {
            break;
        }
    }
    return soup;
}

}  // namespace pent::mesher
