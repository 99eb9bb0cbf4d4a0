#include "number_reader.h"
#include "tet_readers.h"
#include "vtk_grid.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pent::mesher {

namespace {

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

    // Reads the mesh alone, or its arrays too.
    VtkGrid read(bool with_arrays) {
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
                if (with_arrays) {
                    read_arrays(keyword == "POINT_DATA");
                }
                break;
            }
        }
        return std::move(grid_);
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
            grid_.soup.points.push_back(is_double ? numbers_.point<double>()
                                                  : numbers_.point<float>());
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
            const std::string keyword(text_.word());
            std::vector<VtkArray>& arrays = is_of_points ? grid_.point_arrays : grid_.cell_arrays;
            const std::int64_t rows = is_of_points ? point_count() : grid_.cell_count;
            if (keyword == "POINT_DATA" || keyword == "CELL_DATA") {
                is_of_points = keyword == "POINT_DATA";
                expect_count(is_of_points);
            } else if (keyword == "SCALARS") {
                arrays.push_back(read_scalars(rows));
            } else if (keyword == "VECTORS" || keyword == "NORMALS") {
                const std::string name(text_.next_word("the name of an array"));
                arrays.push_back(
                    read_values(name, 3, rows, std::string(text_.next_word("a type"))));
            } else if (keyword == "TENSORS") {
                const std::string name(text_.next_word("the name of an array"));
                arrays.push_back(
                    read_values(name, 9, rows, std::string(text_.next_word("a type"))));
            } else if (keyword == "FIELD") {
                read_field(arrays, rows);
            } else if (keyword == "LOOKUP_TABLE") {
                skip_lookup_table();
            } else if (keyword != "METADATA" && keyword != "INFORMATION" && keyword != "NAME"
                       && keyword != "DATA") {
                text_.fail("found \"" + keyword.substr(0, 40)
                           + "\", expected SCALARS, VECTORS, NORMALS, TENSORS, FIELD, LOOKUP_TABLE,"
                             " POINT_DATA or CELL_DATA");
            }
        }
    }

    [[nodiscard]] std::int64_t point_count() const {
        return static_cast<std::int64_t>(grid_.soup.points.size());
    }

    void expect_count(bool is_of_points) {
        const std::int64_t count = line_count();
        const std::int64_t expected = is_of_points ? point_count() : grid_.cell_count;
        if (count != expected) {
            text_.fail("data of " + std::to_string(count)
                       + (is_of_points ? " points, of " : " cells, of ")
                       + std::to_string(expected));
        }
    }

    VtkArray read_scalars(std::int64_t rows) {
        const std::string name(text_.next_word("the name of an array"));
        const std::string type(text_.next_word("a type"));
        const std::string_view word = text_.word();
        const std::int64_t components =
            word.empty() ? 1 : text_.count(word, "a number of components");
        const std::string_view keyword = text_.next_word("LOOKUP_TABLE");
        if (keyword != "LOOKUP_TABLE") {
            text_.fail("found \"" + std::string(keyword.substr(0, 40))
                       + "\", expected LOOKUP_TABLE");
        }
        text_.skip_line();
        return read_values(name, components, rows, type);
    }

    void read_field(std::vector<VtkArray>& arrays, std::int64_t rows) {
        static_cast<void>(text_.word());  // its name
        const std::int64_t count = line_count();
        for (std::int64_t i = 0; i < count; ++i) {
            std::string name(text_.next_word("the name of an array"));
            while (name == "METADATA" || name == "INFORMATION" || name == "NAME"
                   || name == "DATA") {  // of the array before
                text_.skip_line();
                name = text_.next_word("the name of an array");
            }
            const std::int64_t components = line_count();
            const std::int64_t found = line_count();
            if (found != rows) {
                text_.fail("array " + name.substr(0, 40) + " has " + std::to_string(found)
                           + " rows, expected " + std::to_string(rows));
            }
            arrays.push_back(
                read_values(name, components, rows, std::string(text_.next_word("a type"))));
        }
    }

    // Colors of a table of their own.
    void skip_lookup_table() {
        static_cast<void>(text_.next_word("the name of a table"));
        const std::int64_t size = 4 * line_count();
        for (std::int64_t i = 0; i < size; ++i) {
            static_cast<void>(numbers_.is_text()
                                  ? text_.number(text_.next_word("a color"), "a color")
                                  : numbers_.real<std::uint8_t>("a color"));
        }
    }

    VtkArray read_values(const std::string& name,
                         std::int64_t components,
                         std::int64_t rows,
                         const std::string& type) {
        VtkArray array{name, components, {}};
        if (components > text_.size()) {
            text_.fail(std::to_string(components) + " components; the file has fewer bytes");
        }
        for (std::int64_t i = 0; i < rows * components; ++i) {
            array.values.push_back(value_of_type(type));
        }
        return array;
    }

    double value_of_type(const std::string& type) {
        if (type == "float") {
            return numbers_.real<float>("a number");
        }
        if (type == "double") {
            return numbers_.real<double>("a number");
        }
        const bool is_unsigned = type.starts_with("unsigned") || type == "vtktypeuint64";
        switch (bytes_of(type)) {
            case 1:
                return is_unsigned ? numbers_.real<std::uint8_t>("a number")
                                   : numbers_.real<std::int8_t>("a number");
            case 2:
                return is_unsigned ? numbers_.real<std::uint16_t>("a number")
                                   : numbers_.real<std::int16_t>("a number");
            case 4:
                return is_unsigned ? numbers_.real<std::uint32_t>("a number")
                                   : numbers_.real<std::int32_t>("a number");
            default:
                return is_unsigned ? numbers_.real<std::uint64_t>("a number")
                                   : numbers_.real<std::int64_t>("a number");
        }
    }

    TextReader text_;
    NumberReader numbers_;
    VtkGrid grid_;
    Cells cells_;
};

}  // namespace

CellSoup read_vtk(const std::filesystem::path& path) {
    return VtkReader(path).read(false).soup;
}

VtkGrid read_vtk_grid(const std::filesystem::path& path) {
    return VtkReader(path).read(true);
}

}  // namespace pent::mesher
