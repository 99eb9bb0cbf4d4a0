#include "number_reader.h"
#include "tet_readers.h"
#include "vtk_grid.h"

#include <pent/real_text.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string>
#include <system_error>
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

// How many numbers a row has of an array with this keyword; 0 where more stands in front of a type.
std::int64_t components_of(std::string_view keyword) {
    constexpr std::array<std::pair<std::string_view, std::int64_t>, 7> kComponents = {
        {{"VECTORS", 3},
         {"NORMALS", 3},
         {"TENSORS", 9},
         {"TENSORS6", 6},
         {"GLOBAL_IDS", 1},
         {"PEDIGREE_IDS", 1},
         {"EDGE_FLAGS", 1}}};
    for (const auto& [known, components] : kComponents) {
        if (keyword == known) {
            return components;
        }
    }
    return 0;
}

// A name is one word in the file: "%20" stands for a space, as do other two digits behind a "%" for
// the byte of that number.
std::string decoded(std::string_view word) {
    std::string name;
    for (std::size_t i = 0; i < word.size(); ++i) {
        unsigned byte = 0;
        const std::string_view digits = word.substr(i + 1, 2);
        const char* const end = digits.data() + digits.size();
        if (word[i] == '%' && digits.size() == 2
            && std::from_chars(digits.data(), end, byte, 16).ptr == end) {
            name += static_cast<char>(byte);
            i += 2;
        } else {
            name += word[i];
        }
    }
    return name;
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

    VtkGrid read() {
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
                read_arrays(keyword == "POINT_DATA");
            }
        }
        return std::move(grid_);
    }

private:
    void read_start() {
        if (!text_.next_line() || text_.word() != "#") {
            text_.fail("no \"# vtk DataFile\" at the start; expected a legacy VTK file");
        }
        static_cast<void>(take_line());  // a title
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

    // The line behind the current one, which may have no word.
    std::string_view take_line() {
        const std::string_view rest = text_.rest();
        return text_.take_bytes(std::min(rest.find('\n'), rest.size() - 1) + 1, "a line");
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
            } else if (const std::int64_t components = components_of(keyword); components > 0) {
                const std::string name = decoded(text_.next_word("the name of an array"));
                arrays.push_back(
                    read_values(name, components, rows, std::string(text_.next_word("a type"))));
            } else if (keyword == "TEXTURE_COORDINATES") {
                const std::string name = decoded(text_.next_word("the name of an array"));
                const std::int64_t dimension = line_count();
                arrays.push_back(
                    read_values(name, dimension, rows, std::string(text_.next_word("a type"))));
            } else if (keyword == "COLOR_SCALARS") {
                const std::string name = decoded(text_.next_word("the name of an array"));
                arrays.push_back(read_values(name, line_count(), rows, "unsigned_char"));
            } else if (keyword == "FIELD") {
                read_field(arrays, rows);
            } else if (keyword == "LOOKUP_TABLE") {
                skip_lookup_table();
            } else if (keyword == "METADATA") {
                skip_metadata();
            } else {
                text_.fail("found \"" + keyword.substr(0, 40)
                           + "\", expected SCALARS, VECTORS, NORMALS, TENSORS, FIELD, LOOKUP_TABLE,"
                             " POINT_DATA, CELL_DATA or another keyword of arrays");
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
        const std::string name = decoded(text_.next_word("the name of an array"));
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
            while (name == "METADATA") {  // of the array before
                skip_metadata();
                name = text_.next_word("the name of an array");
            }
            const std::int64_t components = line_count();
            const std::int64_t found = line_count();
            if (found != rows) {
                text_.fail("array " + name.substr(0, 40) + " has " + std::to_string(found)
                           + " rows, expected " + std::to_string(rows));
            }
            const std::string type(text_.next_word("a type"));
            if (type == "string") {
                skip_strings(components * rows);
            } else {
                arrays.push_back(read_values(decoded(name), components, rows, type));
            }
        }
    }

    // Names of components and the like, to an empty line.
    void skip_metadata() {
        while (!text_.rest().empty()
               && take_line().find_first_not_of(" \t\r\n") != std::string_view::npos) {
        }
    }

    // Lines of text; or bytes, of which the first two bits say in how many the length stands.
    void skip_strings(std::int64_t count) {
        for (std::int64_t i = 0; i < count; ++i) {
            if (text_.rest().empty()) {
                text_.fail("the file ends here; expected a string");
            }
            if (numbers_.is_text()) {
                static_cast<void>(take_line());
                continue;
            }
            const auto first = static_cast<std::uint8_t>(text_.take_bytes(1, "a string").front());
            std::size_t length = first & 63U;
            for (const char c : text_.take_bytes((8U >> (first >> 6U)) - 1U, "a string")) {
                length = length << 8U | static_cast<std::uint8_t>(c);
            }
            static_cast<void>(text_.take_bytes(length, "a string"));
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
        const std::int64_t count = rows * components;
        if (type == "bit" && !numbers_.is_text()) {
            for (std::int64_t i = 0; i < count; i += 8) {
                const auto byte = static_cast<std::uint8_t>(text_.take_bytes(1, "bits").front());
                for (std::int64_t bit = 7; bit >= std::max<std::int64_t>(8 - (count - i), 0);
                     --bit) {
                    array.values.push_back(byte >> bit & 1);
                }
            }
            return array;
        }
        for (std::int64_t i = 0; i < count; ++i) {
            array.values.push_back(value_of_type(type));
        }
        return array;
    }

    double value_of_type(const std::string& type) {
        if (numbers_.is_text()) {
            return any_number(text_.next_word("a number"));
        }
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

    // A quantity need not be finite, as the place of a point is.
    double any_number(std::string_view word) {
        double value = 0;
        const auto [end, error] = real_from_chars(word.data(), word.data() + word.size(), value);
        const bool is_number = error == std::errc() && end == word.data() + word.size();
        return is_number ? value : text_.number(word, "a number");
    }

    TextReader text_;
    NumberReader numbers_;
    VtkGrid grid_;
    Cells cells_;
};

}  // namespace

CellSoup read_vtk(const std::filesystem::path& path, const std::string& regions) {
    return labeled_soup(VtkReader(path).read(), regions, path);
}

VtkGrid read_vtk_grid(const std::filesystem::path& path) {
    return VtkReader(path).read();
}

}  // namespace pent::mesher
