#include "number_reader.h"
#include "tet_readers.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pent::mesher {

namespace {

// VTK's number for a type of cells and what it is. In all of them the corners come first.
constexpr std::array<std::pair<std::int64_t, CellKind>, 50> kTypes = {{
    {1, CellKind::Point},
    {2, CellKind::Point},
    {3, CellKind::Line},
    {4, CellKind::Line},
    {5, CellKind::Triangle},
    {6, CellKind::Polygon},  // a strip of triangles
    {7, CellKind::Polygon},
    {8, CellKind::Quadrilateral},  // a pixel
    {9, CellKind::Quadrilateral},
    {10, CellKind::Tetrahedron},
    {11, CellKind::Hexahedron},
    {12, CellKind::Hexahedron},  // the first of these a voxel
    {13, CellKind::Prism},
    {14, CellKind::Pyramid},
    {15, CellKind::PentagonalPrism},
    {16, CellKind::HexagonalPrism},
    {21, CellKind::Line},
    {22, CellKind::Triangle},
    {23, CellKind::Quadrilateral},
    {24, CellKind::Tetrahedron},
    {25, CellKind::Hexahedron},
    {26, CellKind::Prism},
    {27, CellKind::Pyramid},
    {28, CellKind::Quadrilateral},
    {29, CellKind::Hexahedron},
    {30, CellKind::Quadrilateral},
    {31, CellKind::Prism},
    {32, CellKind::Prism},
    {33, CellKind::Hexahedron},
    {34, CellKind::Triangle},
    {35, CellKind::Line},
    {36, CellKind::Polygon},
    {37, CellKind::Pyramid},
    {41, CellKind::Polyhedron},
    {42, CellKind::Polyhedron},
    {68, CellKind::Line},
    {69, CellKind::Triangle},
    {70, CellKind::Quadrilateral},
    {71, CellKind::Tetrahedron},
    {72, CellKind::Hexahedron},
    {73, CellKind::Prism},
    {74, CellKind::Pyramid},
    {75, CellKind::Line},
    {76, CellKind::Triangle},
    {77, CellKind::Quadrilateral},
    {78, CellKind::Tetrahedron},
    {79, CellKind::Hexahedron},
    {80, CellKind::Prism},
    {81, CellKind::Pyramid},
    {0, CellKind::Point},  // empty
}};
constexpr std::int64_t kEmpty = 0;
constexpr std::int64_t kVoxel = 11;

CellKind kind_of(const TextReader& text, std::int64_t number) {
    for (const auto& [known, kind] : kTypes) {
        if (number == known) {
            return kind;
        }
    }
    text.fail("a cell of VTK's type " + std::to_string(number) + "; expected 0 to 16, 21 to 37, 41,"
              " 42 or 68 to 81");
}

// Bytes of a value of a type of arrays, or nothing for types without a fixed size.
std::optional<std::size_t> size_of(std::string_view type) {
    constexpr std::array<std::pair<std::string_view, std::size_t>, 14> kSizes = {
        {{"char", 1},
         {"unsigned_char", 1},
         {"short", 2},
         {"unsigned_short", 2},
         {"int", 4},
         {"unsigned_int", 4},
         {"long", 8},
         {"unsigned_long", 8},
         {"float", 4},
         {"double", 8},
         {"vtktypeint64", 8},
         {"vtktypeuint64", 8},
         {"vtkIdType", 4},  // written as int
         {"vtktypeint32", 4}}};
    for (const auto& [known, size] : kSizes) {
        if (type == known) {
            return size;
        }
    }
    return std::nullopt;
}

// The corners of all cells one after the other, and where each begins; one more for the end.
struct Cells {
    std::vector<std::int64_t> corners;
    std::vector<std::int64_t> first = {0};

    [[nodiscard]] std::int64_t count() const { return static_cast<std::int64_t>(first.size()) - 1; }
};

class VtkReader {
public:
    explicit VtkReader(const std::filesystem::path& path)
        : text_(path, '\0'), numbers_(text_, Encoding::Text) {}

    CellSoup read() {
        read_start();
        while (text_.next_line()) {
            const std::string_view keyword = text_.word();
            if (keyword == "DATASET") {
                const std::string_view kind = text_.word();
                if (kind != "UNSTRUCTURED_GRID") {
                    text_.fail("dataset " + std::string(kind) + "; expected UNSTRUCTURED_GRID");
                }
            } else if (keyword == "FIELD") {
                skip_field();
            } else if (keyword == "POINTS") {
                read_points();
            } else if (keyword == "CELLS") {
                read_cells();
            } else if (keyword == "CELL_TYPES") {
                read_types();
            } else if (keyword == "POINT_DATA" || keyword == "CELL_DATA") {
                break;
            }
        }
        return std::move(soup_);
    }

private:
    void read_start() {
        if (!text_.next_line() || text_.word() != "#") {
            text_.fail("no \"# vtk DataFile\" at the start; expected a legacy VTK file");
        }
        const std::size_t title = std::min(text_.rest().find('\n'), text_.rest().size());
        static_cast<void>(text_.take_bytes(std::min(title + 1, text_.rest().size()), "a title"));
        if (!text_.next_line()) {
            text_.fail("the file ends here; expected ASCII or BINARY");
        }
        const std::string_view encoding = text_.word();
        if (encoding == "BINARY") {
            numbers_.set_encoding(Encoding::BigEndian);
        } else if (encoding != "ASCII") {
            text_.fail("found \"" + std::string(encoding.substr(0, 40))
                       + "\", expected ASCII or BINARY");
        }
    }

    // Counts stand in lines of text in any case.
    std::int64_t line_count() { return text_.count(text_.next_word("a count"), "a count"); }

    // Throws unless values of this type can be read or skipped.
    std::size_t bytes_of(std::string_view type) {
        const std::optional<std::size_t> size = size_of(type);
        if (!size) {
            text_.fail("values of type \"" + std::string(type.substr(0, 40))
                       + "\"; expected a type of numbers, as float or int");
        }
        return *size;
    }

    void skip_field() {
        static_cast<void>(text_.word());  // its name
        const std::int64_t arrays = line_count();
        for (std::int64_t i = 0; i < arrays && !numbers_.is_text(); ++i) {
            static_cast<void>(text_.next_word("the name of an array"));
            const std::int64_t components = line_count();
            const std::int64_t rows = line_count();
            const std::size_t bytes = bytes_of(text_.word());
            for (std::int64_t row = 0; row < rows; ++row) {
                static_cast<void>(text_.take_bytes(static_cast<std::size_t>(components) * bytes,
                                                   "a row of an array"));
            }
        }
    }

    void read_points() {
        const std::int64_t count = line_count();
        const std::string_view type = text_.next_word("a type");
        if (!numbers_.is_text() && type != "float" && type != "double") {
            text_.fail("points of type \"" + std::string(type.substr(0, 40))
                       + "\"; expected float or double");
        }
        const bool is_double = type == "double";
        for (std::int64_t i = 0; i < count; ++i) {
            soup_.points.push_back(is_double ? numbers_.point<double>() : numbers_.point<float>());
        }
    }

    void read_cells() {
        const std::int64_t count = line_count();
        const std::int64_t size = line_count();
        text_.skip_line();
        cells_ = Cells();
        const std::string_view rest = text_.rest();
        const std::size_t start = rest.find_first_not_of(" \t\r\n");
        if (start != std::string_view::npos && rest.substr(start).starts_with("OFFSETS")) {
            read_cells_with_offsets(count, size);
        } else {
            read_cells_with_sizes(count);
        }
    }

    // Files up to version 4: the number of corners before each cell.
    void read_cells_with_sizes(std::int64_t count) {
        for (std::int64_t cell = 0; cell < count; ++cell) {
            const std::int64_t size = numbers_.count<std::int32_t>("the number of corners");
            for (std::int64_t i = 0; i < size; ++i) {
                cells_.corners.push_back(numbers_.whole<std::int32_t>("a corner"));
            }
            cells_.first.push_back(static_cast<std::int64_t>(cells_.corners.size()));
        }
    }

    // Files from version 5 on: where each cell begins, then all corners.
    void read_cells_with_offsets(std::int64_t offsets, std::int64_t corners) {
        static_cast<void>(text_.next_word("OFFSETS"));
        const std::vector<std::int64_t> first = read_array(offsets, "an offset");
        for (std::size_t i = 0; i < first.size(); ++i) {
            if (first[i] < (i == 0 ? 0 : first[i - 1]) || first[i] > corners) {
                text_.fail("offset " + std::to_string(first[i]) + " of " + std::to_string(corners));
            }
        }
        const std::string_view keyword = text_.next_word("CONNECTIVITY");
        if (keyword != "CONNECTIVITY") {
            text_.fail("found \"" + std::string(keyword.substr(0, 40))
                       + "\", expected CONNECTIVITY");
        }
        cells_.corners = read_array(corners, "a corner");
        if (!first.empty()) {
            cells_.first = first;
        }
    }

    std::vector<std::int64_t> read_array(std::int64_t count, std::string_view expected) {
        const bool is_long = bytes_of(text_.next_word("a type")) == 8;
        std::vector<std::int64_t> values;
        for (std::int64_t i = 0; i < count; ++i) {
            values.push_back(is_long ? numbers_.whole<std::int64_t>(expected)
                                     : numbers_.whole<std::int32_t>(expected));
        }
        return values;
    }

    void read_types() {
        const std::int64_t count = line_count();
        if (count != cells_.count()) {
            text_.fail(std::to_string(count) + " types of " + std::to_string(cells_.count())
                       + " cells");
        }
        for (std::int64_t cell = 0; cell < count; ++cell) {
            const std::int64_t type = numbers_.whole<std::int32_t>("the type of a cell");
            if (type != kEmpty) {
                add_cell(cell, type);
            }
        }
    }

    void add_cell(std::int64_t cell, std::int64_t type) {
        const CellKind kind = kind_of(text_, type);
        const std::int64_t count = cells_.first[cell + 1] - cells_.first[cell];
        if (count < static_cast<std::int64_t>(corners_of(kind))) {
            CellCounts one{};
            one[static_cast<std::size_t>(kind)] = 1;
            text_.fail(list_counts(one, kind, kind) + " with " + std::to_string(count)
                       + " corners; expected " + std::to_string(corners_of(kind)));
        }
        nodes_.clear();
        for (std::int64_t i = 0; i < count && corners_of(kind) > 0; ++i) {
            nodes_.push_back(text_.index(cells_.corners[cells_.first[cell] + i],
                                         static_cast<std::int64_t>(soup_.points.size())));
        }
        if (type == kVoxel) {  // it counts along the axes, not around its sides
            std::swap(nodes_[2], nodes_[3]);
            std::swap(nodes_[6], nodes_[7]);
        }
        soup_.add(kind, nodes_);
    }

    TextReader text_;
    NumberReader numbers_;
    CellSoup soup_;
    Cells cells_;
    std::vector<std::uint32_t> nodes_;  // of one cell
};

}  // namespace

CellSoup read_vtk(const std::filesystem::path& path) {
    return VtkReader(path).read();
}

}  // namespace pent::mesher
