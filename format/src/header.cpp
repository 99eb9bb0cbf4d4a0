#include "header.h"

#include <pent/crc32c.h>
#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/printable.h>
#include <pent/real_text.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>

namespace pent {

namespace {

// Comments with a meaning; others are ignored.
constexpr std::array<std::string_view, 9> kComments = {
    "pent", "dimension", "created_by", "crc32c", "header_crc32c", "mesh", "frame", "step", "time"};

constexpr std::uint64_t kMaxRows = 0xFFFFFFFFU;  // of vertices and cells: indices are 32 bits wide

std::vector<std::string_view> split(std::string_view line) {
    std::vector<std::string_view> words;
    std::size_t at = 0;
    while (at < line.size()) {
        const std::size_t end = std::min(line.find(' ', at), line.size());
        if (end > at) {
            words.push_back(line.substr(at, end - at));
        }
        at = end + 1;
    }
    return words;
}

template <typename Number>
std::optional<Number> number(std::string_view word, int base = 10) {
    Number value{};
    std::from_chars_result result{};
    if constexpr (std::is_floating_point_v<Number>) {
        result = real_from_chars(word.data(), word.data() + word.size(), value);
    } else {
        result = std::from_chars(word.data(), word.data() + word.size(), value, base);
    }
    if (result.ec != std::errc() || result.ptr != word.data() + word.size()) {
        return std::nullopt;
    }
    return value;
}

std::string quoted(std::string_view text) {
    constexpr std::size_t kLongest = 60;
    std::string shown;
    for (const char c : text.substr(0, kLongest)) {
        shown += c >= ' ' && c < '\x7f' ? c : '?';
    }
    return "'" + shown + (text.size() > kLongest ? "...'" : "'");
}

// "property double x", "property list uint v0".
std::string declaration(const PlyProperty& property) {
    return (property.count_type ? "property list " : "property ")
           + std::string(name_of(property.type)) + " " + property.name;
}

// Reads a header line by line; every failure names the line.
class Parser {
public:
    Parser(std::string_view bytes, const std::filesystem::path& path)
        : bytes_(bytes), path_(path.string()) {}

    Header parse() {
        parse_preamble();
        while (true) {
            const std::string_view line = next_line();
            const std::vector<std::string_view> words = split(line);
            if (line == "end_header") {
                break;
            }
            if (!words.empty() && words[0] == "comment") {
                parse_comment(words, line);
            } else if (words.size() == 3 && words[0] == "element") {
                parse_element(words, line);
            } else if (words.size() >= 3 && words[0] == "property") {
                parse_property(words, line);
            } else {
                fail(line, "a comment, element, property or end_header line");
            }
        }
        header_.body = at_;
        check_checksum();
        return header_;
    }

private:
    [[noreturn]] void fail(std::string_view found, const std::string& expected) const {
        throw Error(path_ + ": header line " + std::to_string(line_) + ": found " + quoted(found)
                    + ", expected " + expected);
    }

    std::string_view next_line() {
        ++line_;
        if (at_ >= bytes_.size()) {
            throw Error(path_ + ": header line " + std::to_string(line_)
                        + ": the file ends here, expected more header up to end_header");
        }
        const std::size_t end = bytes_.find('\n', at_);
        if (end == std::string_view::npos || end - at_ > kLongestLine) {
            fail(bytes_.substr(at_, kLongestLine), line_ == 1 && bytes_ != "ply"
                                                       ? "'ply' (is this a .pent file?)"
                                                       : "a line that ends with a newline");
        }
        const std::string_view line = bytes_.substr(at_, end - at_);
        at_ = end + 1;
        if (!line.empty() && line.back() == '\r') {
            fail(line, "lines that end with LF alone (CR LF comes from a text-mode transfer)");
        }
        return line;
    }

    void parse_preamble() {
        if (bytes_.empty()) {
            throw Error(path_ + ": the file is empty, expected a .pent file");
        }
        std::string_view line = next_line();
        if (line != "ply") {
            fail(line, "'ply' (is this a .pent file?)");
        }
        line = next_line();
        if (line == "format ascii 1.0") {
            header_.info.encoding = Encoding::Ascii;
        } else if (line != "format binary_little_endian 1.0") {
            fail(line, "'format binary_little_endian 1.0' or 'format ascii 1.0'");
        }
        line = next_line();
        if (line != "comment pent 1.0") {
            fail(line, "'comment pent 1.0'");
        }
        line = next_line();
        for (const int dim : {2, 3, 4}) {
            if (line == "comment dimension " + std::to_string(dim)) {
                header_.info.dimension = dim;
            }
        }
        if (header_.info.dimension == 0) {
            fail(line, "'comment dimension D' with D = 2, 3 or 4");
        }
    }

    void parse_comment(const std::vector<std::string_view>& words, std::string_view line) {
        const std::string_view key = words.size() > 1 ? words[1] : "";
        if (std::find(kComments.begin(), kComments.end(), key) == kComments.end()) {
            return;
        }
        if (!header_.elements.empty()) {
            fail(line, "the comment '" + std::string(key) + "' in front of the first element");
        }
        if (key == "pent" || key == "dimension" || !seen_.insert(std::string(key)).second) {
            fail(line, "the comment '" + std::string(key) + "' only once");
        }
        if (key == "created_by") {
            const std::size_t prefix = std::string_view("comment created_by ").size();
            header_.info.created_by = line.size() > prefix ? line.substr(prefix) : "";
        } else if (key == "crc32c") {
            header_.info.crc32c = parse_crc(words, 2, line);
            header_.has_checksum = true;
        } else if (key == "header_crc32c") {
            checksum_ = parse_crc(words, 2, line);
            checksum_begin_ = static_cast<std::size_t>(line.data() - bytes_.data());
        } else if (key == "mesh") {
            header_.info.is_frame = true;
            header_.mesh_crc = parse_crc(words, 3, line);
            header_.mesh_name = printable(words[2]);
        } else if (key == "frame") {
            header_.frame = parse_value<std::uint64_t>(words, line);
        } else if (key == "step") {
            header_.step = parse_value<std::uint64_t>(words, line);
        } else {
            header_.time = parse_value<double>(words, line);
            if (!std::isfinite(header_.time)) {
                fail(line, "a finite time in seconds");
            }
        }
    }

    [[nodiscard]] std::uint32_t parse_crc(const std::vector<std::string_view>& words,
                                          std::size_t word,
                                          std::string_view line) const {
        const bool has_form = words.size() == word + 1 && words[word].size() == 8;
        const auto value = has_form ? number<std::uint32_t>(words[word], 16) : std::nullopt;
        if (!value) {
            fail(line, std::string("'comment ") + (word == 2 ? std::string(words[1]) : "mesh NAME")
                           + " XXXXXXXX' with 8 hexadecimal digits");
        }
        return *value;
    }

    template <typename Number>
    [[nodiscard]] Number parse_value(const std::vector<std::string_view>& words,
                                     std::string_view line) const {
        const auto value = words.size() == 3 ? number<Number>(words[2]) : std::nullopt;
        if (!value) {
            fail(line, "'comment " + std::string(words[1]) + " NUMBER'");
        }
        return *value;
    }

    void parse_element(const std::vector<std::string_view>& words, std::string_view line) {
        const auto count = number<std::uint64_t>(words[2]);
        if (!count) {
            fail(line, "'element NAME COUNT' with a count of 0 to 2^64 - 1");
        }
        const std::string name = printable(words[1]);  // a zero byte would end messages early
        for (const PlyElement& element : header_.elements) {
            if (element.name == name) {
                fail(line, "each element only once");
            }
        }
        header_.elements.push_back({name, *count, {}});
    }

    [[nodiscard]] PlyType parse_type(std::string_view word, std::string_view line) const {
        if (const std::optional<PlyType> type = ply_type_called(word)) {
            return *type;
        }
        fail(line, "a PLY type: char uchar short ushort int uint float double");
    }

    void parse_property(const std::vector<std::string_view>& words, std::string_view line) {
        if (header_.elements.empty()) {
            fail(line, "an element line in front of the first property");
        }
        PlyProperty property;
        if (words[1] == "list" && words.size() == 5) {
            property.count_type = parse_type(words[2], line);
            if (*property.count_type == PlyType::Float || *property.count_type == PlyType::Double) {
                fail(line, "a whole-number type for the length of a list");
            }
            property.type = parse_type(words[3], line);
            property.name = printable(words[4]);
        } else if (words[1] != "list" && words.size() == 3) {
            property.type = parse_type(words[1], line);
            property.name = printable(words[2]);
        } else {
            fail(line, "'property TYPE NAME' or 'property list TYPE TYPE NAME'");
        }
        for (const PlyProperty& other : header_.elements.back().properties) {
            if (other.name == property.name) {
                fail(line, "each property only once in an element");
            }
        }
        header_.elements.back().properties.push_back(std::move(property));
    }

    // Of every byte but the line that has it; files of version 0.1.0 have none.
    void check_checksum() const {
        if (!checksum_) {
            return;
        }
        const std::string_view before = bytes_.substr(0, checksum_begin_);
        const std::size_t next = bytes_.find('\n', checksum_begin_) + 1;
        const std::uint32_t found =
            crc32c(bytes_.data() + next, header_.body - next, crc32c(before.data(), before.size()));
        if (found != *checksum_) {
            throw Error(path_ + ": header: its checksum is " + formatted("%08x", found)
                        + ", the header says " + formatted("%08x", *checksum_)
                        + ": it was changed since it was written");
        }
    }

    std::string_view bytes_;
    std::string path_;
    std::size_t at_ = 0;
    int line_ = 0;
    Header header_;
    std::optional<std::uint32_t> checksum_;  // of the header
    std::size_t checksum_begin_ = 0;         // of the line that has it
    std::set<std::string> seen_;
};

// What stands in an element's place, for messages.
std::string name_of(const Header& header, std::size_t element) {
    return element < header.elements.size() ? "element " + header.elements[element].name
                                            : "no element";
}

// The known elements must begin with their required properties, in order.
void check_prefix(const PlyElement& element,
                  const std::vector<std::string>& names,
                  PlyType type,
                  const std::string& where) {
    for (std::size_t i = 0; i < names.size(); ++i) {
        const bool is_missing = i >= element.properties.size();
        const PlyProperty found = is_missing ? PlyProperty{} : element.properties[i];
        if (is_missing || found.name != names[i] || found.type != type || found.count_type) {
            throw Error(where + "property " + std::to_string(i) + " of element " + element.name
                        + (is_missing ? " is missing" : " is '" + declaration(found) + "'")
                        + ", expected '" + declaration({names[i], type, std::nullopt}) + "'");
        }
    }
    for (const PlyProperty& property : element.properties) {
        if (property.count_type) {
            throw Error(where + "element " + element.name + " has the list property "
                        + property.name + ", expected properties of fixed width");
        }
    }
}

void check_count(const PlyElement& element, const std::string& where) {
    if (element.count > kMaxRows) {
        throw Error(where + "element " + element.name + " has " + std::to_string(element.count)
                    + " rows, expected at most " + std::to_string(kMaxRows));
    }
}

void check_vertices(const Header& header, const std::string& where) {
    if (header.elements.empty() || header.elements[0].name != "vertex") {
        throw Error(where + "found " + name_of(header, 0)
                    + (header.elements.empty() ? "" : " first")
                    + ", expected element vertex first");
    }
    const PlyElement& vertices = header.elements[0];
    check_count(vertices, where);
    const std::array<std::string, 4> axes = {"x", "y", "z", "w"};
    check_prefix(vertices, {axes.begin(), axes.begin() + header.info.dimension}, PlyType::Double,
                 where);
    if (header.info.encoding == Encoding::Binary && !header.has_checksum) {
        throw Error(where + "no 'comment crc32c', expected one in a binary file");
    }
}

void check_cells(const Header& header, const std::string& where) {
    const int dim = header.info.dimension;
    const std::string cells(cell_name(dim));
    if (header.elements.size() < 2 || header.elements[1].name != cells) {
        throw Error(where + "found " + name_of(header, 1)
                    + " after element vertex, expected element " + cells + " (dimension "
                    + std::to_string(dim) + ")");
    }
    check_count(header.elements[1], where);
    const std::array<std::string, 5> corners = {"v0", "v1", "v2", "v3", "v4"};
    check_prefix(header.elements[1], {corners.begin(), corners.begin() + dim + 1}, PlyType::Uint,
                 where);
}

std::string shortest(double value) {
    std::array<char, 32> text{};
    const auto result = real_to_chars(text.data(), text.data() + text.size(), value);
    return {text.data(), result.ptr};
}

}  // namespace

std::size_t size_of(PlyType type) {
    return kPlyTypes[static_cast<std::size_t>(type)].size;
}

std::string_view name_of(PlyType type) {
    return kPlyTypes[static_cast<std::size_t>(type)].name;
}

Header parse_header(std::string_view bytes, const std::filesystem::path& path) {
    Header header = Parser(bytes, path).parse();
    const std::string where = path.string() + ": header: ";
    check_vertices(header, where);
    header.info.vertices = header.elements[0].count;
    if (!header.info.is_frame) {
        check_cells(header, where);
        header.info.cells = header.elements[1].count;
    }
    return header;
}

void refuse_frame(const Header& header, const std::filesystem::path& path) {
    if (header.info.is_frame) {
        throw Error(path.string() + ": header: this is a frame of the mesh " + header.mesh_name
                    + ", expected a mesh");
    }
}

std::string format_header(const Header& header) {
    std::string created_by = header.info.created_by;
    std::replace_if(
        created_by.begin(), created_by.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    std::string text = "ply\nformat ";
    text += header.info.encoding == Encoding::Ascii ? "ascii" : "binary_little_endian";
    text += " 1.0\ncomment pent 1.0\ncomment dimension " + std::to_string(header.info.dimension);
    text += "\ncomment created_by " + created_by;
    if (header.info.is_frame) {
        text += "\ncomment mesh " + header.mesh_name + " " + formatted("%08x", header.mesh_crc);
        text += "\ncomment frame " + std::to_string(header.frame);
        text += "\ncomment step " + std::to_string(header.step);
        text += "\ncomment time " + shortest(header.time);
    }
    text += "\ncomment crc32c " + formatted("%08x", header.info.crc32c) + "\n";
    std::string elements;
    for (const PlyElement& element : header.elements) {
        elements += "element " + element.name + " " + std::to_string(element.count) + "\n";
        for (const PlyProperty& property : element.properties) {
            elements += declaration(property) + "\n";
        }
    }
    elements += "end_header\n";
    const std::uint32_t sum =
        crc32c(elements.data(), elements.size(), crc32c(text.data(), text.size()));
    return text + "comment header_crc32c " + formatted("%08x", sum) + "\n" + elements;
}

}  // namespace pent
