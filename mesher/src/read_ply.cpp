#include "number_reader.h"
#include "surface_readers.h"

#include <pent/counted.h>
#include <pent/error.h>
#include <pent/ply_elements.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pent::mesher {

namespace {

struct Header {
    Encoding encoding = Encoding::Text;
    std::vector<PlyElement> elements;
};

PlyType type_called(std::string_view word, const TextReader& text) {
    if (const std::optional<PlyType> type = ply_type_called(word)) {
        return *type;
    }
    text.fail("type \"" + std::string(word) + "\"; expected one of PLY's, as in float or uchar");
}

Encoding read_encoding(TextReader& text) {
    const std::string_view word = text.word();
    if (word == "ascii") {
        return Encoding::Text;
    }
    if (word == "binary_little_endian") {
        return Encoding::LittleEndian;
    }
    if (word == "binary_big_endian") {
        return Encoding::BigEndian;
    }
    text.fail("format \"" + std::string(word)
              + "\"; expected ascii, binary_little_endian or binary_big_endian");
}

PlyProperty read_property(TextReader& text) {
    PlyProperty property;
    std::string_view word = text.word();
    if (word == "list") {
        property.count_type = type_called(text.word(), text);
        word = text.word();
    }
    property.type = type_called(word, text);
    property.name = text.word();
    return property;
}

Header read_header(TextReader& text) {
    Header header;
    if (!text.next_line() || text.word() != "ply") {
        text.fail("no \"ply\" at the start; expected a PLY file");
    }
    while (text.next_line()) {
        const std::string_view keyword = text.word();
        if (keyword == "format") {
            header.encoding = read_encoding(text);
        } else if (keyword == "element") {
            PlyElement element;
            element.name = text.word();
            element.count =
                static_cast<std::uint64_t>(text.count(text.word(), "the number of elements"));
            header.elements.push_back(element);
        } else if (keyword == "property") {
            if (header.elements.empty()) {
                text.fail("a property before the first element");
            }
            header.elements.back().properties.push_back(read_property(text));
        } else if (keyword == "end_header") {
            return header;
        } else if (keyword != "comment" && keyword != "obj_info") {
            text.fail("\"" + std::string(keyword) + "\"; expected element, property or end_header");
        }
    }
    text.fail("the file ends within the header");
}

// Values one after the other, from text or bytes.
class Values {
public:
    Values(TextReader& text, Encoding encoding) : text_(text), numbers_(text, encoding) {}

    double next(PlyType type) {
        constexpr std::string_view kExpected = "a value";
        switch (type) {
            case PlyType::Char:
                return numbers_.real<std::int8_t>(kExpected);
            case PlyType::Uchar:
                return numbers_.real<std::uint8_t>(kExpected);
            case PlyType::Short:
                return numbers_.real<std::int16_t>(kExpected);
            case PlyType::Ushort:
                return numbers_.real<std::uint16_t>(kExpected);
            case PlyType::Int:
                return numbers_.real<std::int32_t>(kExpected);
            case PlyType::Uint:
                return numbers_.real<std::uint32_t>(kExpected);
            case PlyType::Float:
                return numbers_.real<float>(kExpected);
            case PlyType::Double:
                return numbers_.real<double>(kExpected);
        }
        return 0;
    }

    // Passes a value that nothing is made of, which may be no finite number.
    void skip(PlyType type) {
        if (numbers_.is_text()) {
            static_cast<void>(text_.next_word("a value"));
        } else {
            static_cast<void>(next(type));
        }
    }

    // A whole number from 0 up to and without `end`.
    std::int64_t next_below(PlyType type, std::int64_t end, const std::string& what) {
        const double value = next(type);
        if (!(value >= 0) || value >= static_cast<double>(end) || value != std::floor(value)) {
            fail(what + " " + std::to_string(value) + "; expected a whole number below "
                 + std::to_string(end));
        }
        return static_cast<std::int64_t>(value);
    }

    [[noreturn]] void fail(const std::string& message) const { text_.fail(message); }

private:
    TextReader& text_;
    NumberReader numbers_;
};

// Reads a list; its values are left in `corners` if they are those of a polygon.
void read_list(const PlyProperty& property,
               Values& values,
               std::int64_t points,
               std::int64_t longest,
               std::vector<std::uint32_t>* corners) {
    const std::int64_t count = values.next_below(*property.count_type, longest, "a list of length");
    for (std::int64_t i = 0; i < count; ++i) {
        if (corners != nullptr) {
            corners->push_back(
                static_cast<std::uint32_t>(values.next_below(property.type, points, "a corner")));
        } else {
            values.skip(property.type);
        }
    }
}

// A missing z is 0, for surfaces in the plane.
void require_coordinates(const PlyElement& vertex, const Values& values) {
    for (const char* name : {"x", "y"}) {
        const bool is_there = std::any_of(vertex.properties.begin(), vertex.properties.end(),
                                          [&](const PlyProperty& property) {
                                              return property.name == name && !property.count_type;
                                          });
        if (!is_there) {
            values.fail("the header gives element vertex no property " + std::string(name)
                        + "; expected x, y and z");
        }
    }
}

void read_vertex(const PlyElement& element,
                 Values& values,
                 std::int64_t longest,
                 SoupBuilder& builder) {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    for (const PlyProperty& property : element.properties) {
        const bool is_coordinate =
            property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z';
        if (property.count_type) {
            read_list(property, values, 0, longest, nullptr);
        } else if (is_coordinate) {
            point[property.name[0] - 'x'] = values.next(property.type);
        } else {
            values.skip(property.type);
        }
    }
    if (!point.allFinite()) {
        values.fail("vertex " + std::to_string(builder.point_count())
                    + ": a coordinate is not finite");
    }
    builder.add_point(point);
}

// Reads one row; its polygon is left in `polygon` if it has one.
void read_row(const PlyElement& element,
              Values& values,
              std::int64_t points,
              std::int64_t longest,
              std::vector<std::uint32_t>& polygon) {
    polygon.clear();
    for (const PlyProperty& property : element.properties) {
        if (!property.count_type) {
            values.skip(property.type);
            continue;
        }
        const bool is_polygon =
            element.name == "face"
            && (property.name == "vertex_indices" || property.name == "vertex_index");
        read_list(property, values, points, longest, is_polygon ? &polygon : nullptr);
    }
}

}  // namespace

TriangleSoup read_ply(const std::filesystem::path& path) {
    TextReader text(path, '\0');
    const Header header = read_header(text);
    Values values(text, header.encoding);
    SoupBuilder builder;
    std::vector<std::uint32_t> polygon;
    for (const PlyElement& element : header.elements) {
        if (element.name == "tristrips") {
            values.fail("triangles in strips; expected faces: write the file with faces");
        }
        if (element.name == "vertex") {
            require_coordinates(element, values);
        }
        for (std::uint64_t row = 0; row < element.count; ++row) {
            if (element.name == "vertex") {
                read_vertex(element, values, text.size(), builder);
                continue;
            }
            if (element.name == "edge") {
                builder.leave_out(CellKind::Line);
            }
            read_row(element, values, builder.point_count(), text.size(), polygon);
            if (polygon.size() >= 3) {
                builder.add_polygon(polygon);
            } else if (!polygon.empty()) {
                values.fail("a face with " + counted(polygon.size(), "corner", "corners")
                            + "; expected 3 or more");
            }
        }
    }
    return builder.soup();
}

}  // namespace pent::mesher
