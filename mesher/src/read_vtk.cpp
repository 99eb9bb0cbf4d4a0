#include "legacy_arrays.h"
#include "number_reader.h"
#include "vtk_grid.h"

#include <pent/counted.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace pent::mesher {

namespace {

constexpr std::string_view kWriteSurface = "; write a surface as .ply, .stl, .obj or .off";

// The corners of all cells one after the other, and where each begins; one more for the end.
struct Cells {
    std::vector<std::int64_t> corners;
    std::vector<std::int64_t> first = {0};

    [[nodiscard]] std::int64_t count() const { return static_cast<std::int64_t>(first.size()) - 1; }
};

class VtkReader {
public:
    explicit VtkReader(const std::filesystem::path& path)
        : text_(path, '\0'), numbers_(text_, Encoding::Text), arrays_(text_, numbers_) {}

    FileGrid read() {
        read_start();
        while (text_.next_line()) {
            const std::string word(text_.word());
            const std::string keyword = in_capitals(word);
            if (keyword == "DATASET") {
                const std::string kind(text_.word());
                if (in_capitals(kind) != "UNSTRUCTURED_GRID") {
                    text_.fail(
                        "dataset " + kind.substr(0, 40) + "; expected UNSTRUCTURED_GRID"
                        + (in_capitals(kind) == "POLYDATA" ? std::string(kWriteSurface) : ""));
                }
            } else if (keyword == "FIELD") {
                arrays_.skip_field();
            } else if (keyword == "METADATA") {
                arrays_.skip_metadata();
            } else if (keyword == "POINTS") {
                read_points();
            } else if (keyword == "CELLS") {
                read_cells();
            } else if (keyword == "CELL_TYPES") {
                read_types();
            } else if (keyword == "POINT_DATA" || keyword == "CELL_DATA") {
                read_arrays(keyword == "POINT_DATA");
            } else {
                text_.fail("found \"" + word.substr(0, 40)
                           + "\", expected DATASET, FIELD, POINTS, CELLS, CELL_TYPES, METADATA,"
                             " POINT_DATA or CELL_DATA");
            }
        }
        return std::move(grid_);
    }

private:
    void read_start() {
        if (!text_.next_line() || text_.word() != "#") {
            text_.fail("no \"# vtk DataFile\" at the start; expected a legacy VTK file");
        }
        static_cast<void>(arrays_.take_line());  // a title
        if (!text_.next_line()) {
            text_.fail("the file ends here; expected ASCII or BINARY");
        }
        const std::string word(text_.word());
        const std::string encoding = in_capitals(word);
        if (encoding == "BINARY") {
            numbers_.set_encoding(Encoding::BigEndian);
        } else if (encoding != "ASCII") {
            text_.fail("found \"" + word.substr(0, 40) + "\", expected ASCII or BINARY");
        }
    }

    void read_points() {
        const std::int64_t count = arrays_.line_count();
        const std::string word(text_.next_word("a type"));
        const std::string type = in_capitals(word);
        if (!numbers_.is_text() && type != "FLOAT" && type != "DOUBLE") {
            text_.fail("points of type \"" + word.substr(0, 40) + "\"; expected float or double");
        }
        const bool is_double = type == "DOUBLE";
        for (std::int64_t i = 0; i < count; ++i) {
            grid_.soup.points.push_back(is_double ? numbers_.point<double>()
                                                  : numbers_.point<float>());
        }
    }

    void read_cells() {
        const std::int64_t count = arrays_.line_count();
        const std::int64_t size = arrays_.line_count();
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
        const bool is_long = arrays_.bytes_of(text_.next_word("a type")) == 8;
        std::vector<std::int64_t> values;
        for (std::int64_t i = 0; i < count; ++i) {
            values.push_back(is_long ? numbers_.whole<std::int64_t>(expected)
                                     : numbers_.whole<std::int32_t>(expected));
        }
        return values;
    }

    void read_types() {
        const std::int64_t count = arrays_.line_count();
        if (count != cells_.count()) {
            text_.fail(counted(count, "type", "types") + " of "
                       + counted(cells_.count(), "cell", "cells"));
        }
        const Fail fail = [this](const std::string& message) { text_.fail(message); };
        for (std::int64_t cell = 0; cell < count; ++cell) {
            const std::int64_t type = numbers_.whole<std::int32_t>("the type of a cell");
            const auto first = static_cast<std::size_t>(cells_.first[cell]);
            const auto end = static_cast<std::size_t>(cells_.first[cell + 1]);
            add_cell(grid_, type, std::span(cells_.corners).subspan(first, end - first), fail);
        }
    }

    // The arrays of the points and of the cells, to the end of the file.
    void read_arrays(bool is_of_points) {
        expect_count(is_of_points);
        while (text_.next_line()) {
            const std::string word(text_.word());
            const std::string keyword = in_capitals(word);
            if (keyword == "POINT_DATA" || keyword == "CELL_DATA") {
                is_of_points = keyword == "POINT_DATA";
                expect_count(is_of_points);
            } else if (!arrays_.read(keyword, is_of_points ? point_count() : grid_.cell_count,
                                     is_of_points ? grid_.point_arrays : grid_.cell_arrays)) {
                text_.fail("found \"" + word.substr(0, 40)
                           + "\", expected SCALARS, VECTORS, NORMALS, TENSORS, FIELD, LOOKUP_TABLE,"
                             " POINT_DATA, CELL_DATA or another keyword of arrays");
            }
        }
    }

    [[nodiscard]] std::int64_t point_count() const {
        return static_cast<std::int64_t>(grid_.soup.points.size());
    }

    void expect_count(bool is_of_points) {
        const std::int64_t count = arrays_.line_count();
        const std::int64_t expected = is_of_points ? point_count() : grid_.cell_count;
        if (count != expected) {
            text_.fail("data of "
                       + (is_of_points ? counted(count, "point", "points")
                                       : counted(count, "cell", "cells"))
                       + ", of " + std::to_string(expected));
        }
    }

    TextReader text_;
    NumberReader numbers_;
    LegacyArrays arrays_;
    FileGrid grid_;
    Cells cells_;
};

}  // namespace

FileGrid read_vtk_grid(const std::filesystem::path& path) {
    return VtkReader(path).read();
}

}  // namespace pent::mesher
