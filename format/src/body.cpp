#include "body.h"

#include <pent/crc32c.h>
#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/output_file.h>
#include <pent/real_text.h>

#include <array>
#include <charconv>
#include <cstring>
#include <utility>

namespace pent {

namespace {

// A run of bytes to copy between a row of the file and memory.
struct Run {
    std::size_t in_row = 0;
    char* data = nullptr;
    std::size_t stride = 0;
    std::size_t bytes = 0;
};

// Columns that lie side by side both in a row of the file and in memory become one run.
void add_run(std::vector<Run>& runs, const Column& column, std::size_t in_row) {
    const std::size_t bytes = size_of(column.type);
    if (!runs.empty()) {
        Run& last = runs.back();
        if (last.data + last.bytes == column.data && last.stride == column.stride
            && last.in_row + last.bytes == in_row) {
            last.bytes += bytes;
            return;
        }
    }
    runs.push_back({in_row, column.data, column.stride, bytes});
}

template <typename Value>
void append_number(std::string& text, const char* data) {
    Value value{};
    std::memcpy(&value, data, sizeof value);
    std::array<char, 32> digits{};
    std::to_chars_result result{};
    if constexpr (std::is_floating_point_v<Value>) {
        result = real_to_chars(digits.data(), digits.data() + digits.size(), value);
    } else if constexpr (sizeof(Value) == 1) {
        result = std::to_chars(digits.data(), digits.data() + digits.size(), int{value});
    } else {
        result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    }
    text.append(digits.data(), result.ptr);
}

// Calls visit with a value of the C++ type that a PLY type stands for.
template <typename Visit>
auto with_type(PlyType type, Visit&& visit) {
    switch (type) {
        case PlyType::Char:
            return visit(std::int8_t{});
        case PlyType::Uchar:
            return visit(std::uint8_t{});
        case PlyType::Short:
            return visit(std::int16_t{});
        case PlyType::Ushort:
            return visit(std::uint16_t{});
        case PlyType::Int:
            return visit(std::int32_t{});
        case PlyType::Uint:
            return visit(std::uint32_t{});
        case PlyType::Float:
            return visit(float{});
        case PlyType::Double:
            break;
    }
    return visit(double{});
}

// Parses one number in front of `end`; returns where it ended, or nullptr. Stores it at `target`
// unless that is nullptr.
const char* parse_number(const char* at, const char* end, PlyType type, char* target) {
    return with_type(type, [&](auto value) -> const char* {
        std::from_chars_result result{};
        if constexpr (std::is_floating_point_v<decltype(value)>) {
            result = real_from_chars(at, end, value);
        } else if constexpr (sizeof value == 1) {
            int wide = 0;
            result = std::from_chars(at, end, wide);
            value = static_cast<decltype(value)>(wide);
            if (result.ec == std::errc() && int{value} != wide) {
                return nullptr;
            }
        } else {
            result = std::from_chars(at, end, value);
        }
        if (result.ec != std::errc()) {
            return nullptr;
        }
        if (target != nullptr) {
            std::memcpy(target, &value, sizeof value);
        }
        return result.ptr;
    });
}

std::uint64_t list_length(const char* data, PlyType type) {
    return with_type(type, [&](auto value) {
        std::memcpy(&value, data, sizeof value);
        return value < 0 ? ~std::uint64_t{0} : static_cast<std::uint64_t>(value);
    });
}

// Bytes that a row takes at least: a list may be empty; ascii has one digit and one space a number.
std::size_t least_row_bytes(const PlyElement& element, Encoding encoding) {
    std::size_t bytes = 0;
    for (const PlyProperty& property : element.properties) {
        bytes +=
            encoding == Encoding::Ascii ? 2 : size_of(property.count_type.value_or(property.type));
    }
    return bytes;
}

std::string row_name(const PlyElement& element, std::uint64_t row) {
    return element.name + " " + std::to_string(row);
}

std::string printable(std::string_view text) {
    std::string shown;
    for (const char c : text.substr(0, 20)) {
        shown += c >= ' ' && c < '\x7f' ? c : '?';
    }
    return "'" + shown + "'";
}

const Column* find_column(const std::vector<Column>& columns, const std::string& name) {
    for (const Column& column : columns) {
        if (column.name == name) {
            return &column;
        }
    }
    return nullptr;
}

}  // namespace

void encode_rows(std::string& body,
                 Encoding encoding,
                 const std::vector<Column>& columns,
                 std::uint64_t rows) {
    if (encoding == Encoding::Ascii) {
        for (std::uint64_t row = 0; row < rows; ++row) {
            for (const Column& column : columns) {
                with_type(column.type, [&](auto value) {
                    append_number<decltype(value)>(body, column.data + row * column.stride);
                });
                body += ' ';
            }
            body.back() = '\n';
        }
        return;
    }
    std::vector<Run> runs;
    std::size_t row_bytes = 0;
    for (const Column& column : columns) {
        add_run(runs, column, row_bytes);
        row_bytes += size_of(column.type);
    }
    const std::size_t start = body.size();
    if (runs.size() == 1 && runs[0].stride == row_bytes) {
        body.append(runs[0].data, row_bytes * rows);
        return;
    }
    body.resize(start + row_bytes * rows);
    for (const Run& run : runs) {
        char* target = body.data() + start + run.in_row;
        for (std::uint64_t row = 0; row < rows; ++row) {
            std::memcpy(target + row * row_bytes, run.data + row * run.stride, run.bytes);
        }
    }
}

void check_counts(const Header& header, std::uint64_t bytes, const std::filesystem::path& path) {
    const auto fail = [&](const std::string& where, const std::string& what) {
        throw Error(path.string() + ": " + where + ": " + what);
    };
    std::uint64_t left = bytes;
    const bool is_ascii = header.info.encoding == Encoding::Ascii;
    for (const PlyElement& element : header.elements) {
        const std::size_t row_bytes = least_row_bytes(element, header.info.encoding);
        if (row_bytes > 0 && element.count > left / row_bytes) {
            fail("element " + element.name,
                 "the header announces " + std::to_string(element.count) + " of "
                     + (is_ascii ? "at least " : "") + std::to_string(row_bytes)
                     + " bytes each, but " + std::to_string(left)
                     + " bytes are left: the file is truncated or its header damaged");
        }
        if (row_bytes == 0 && element.count > 0) {
            fail("element " + element.name, "has no properties, expected at least one");
        }
        left -= element.count * row_bytes;
    }
    const bool has_lists =
        std::any_of(header.elements.begin(), header.elements.end(), [](const PlyElement& element) {
            return std::any_of(element.properties.begin(), element.properties.end(),
                               [](const PlyProperty& p) { return p.count_type.has_value(); });
        });
    if (!is_ascii && !has_lists && left > 0) {
        fail("end of file", std::to_string(left) + " bytes follow the last element, expected none");
    }
}

void refuse_checksum(std::uint32_t found,
                     std::uint32_t expected,
                     const std::filesystem::path& path) {
    if (found != expected) {
        throw Error(path.string()
                    + formatted(": checksum: the data has crc32c %08x, expected %08x from the"
                                " header: the file was changed after it was written",
                                found, expected));
    }
}

BodyReader::BodyReader(const Header& header, std::string_view file, std::filesystem::path path)
    : header_(header), body_(file.substr(header.body)), path_(std::move(path)) {
    check_counts(header_, body_.size(), path_);
    if (header_.info.encoding == Encoding::Binary) {
        check_checksum();
    }
}

void BodyReader::fail(const std::string& where, const std::string& what) const {
    throw Error(path_.string() + ": " + where + ": " + what);
}

void BodyReader::check_checksum() const {
    if (header_.has_checksum) {
        refuse_checksum(crc32c(body_.data(), body_.size()), header_.info.crc32c, path_);
    }
}

void BodyReader::read(const std::vector<Column>& columns, std::uint64_t in_front) {
    const PlyElement& element = header_.elements[next_element_++];
    if (header_.info.encoding == Encoding::Ascii) {
        read_ascii(element, columns, in_front);
    } else {
        read_binary(element, columns);
    }
}

void BodyReader::read_binary(const PlyElement& element, const std::vector<Column>& columns) {
    std::vector<Run> runs;
    std::size_t row_bytes = 0;
    for (const PlyProperty& property : element.properties) {
        if (const Column* column = find_column(columns, property.name)) {
            add_run(runs, *column, row_bytes);
        }
        row_bytes += size_of(property.type);
    }
    const char* source = body_.data() + at_;
    at_ += row_bytes * element.count;
    if (runs.size() == 1 && runs[0].stride == row_bytes && runs[0].bytes == row_bytes) {
        std::memcpy(runs[0].data, source, row_bytes * element.count);
        return;
    }
    for (const Run& run : runs) {
        for (std::uint64_t row = 0; row < element.count; ++row) {
            std::memcpy(run.data + row * run.stride, source + row * row_bytes + run.in_row,
                        run.bytes);
        }
    }
}

void BodyReader::read_ascii(const PlyElement& element,
                            const std::vector<Column>& columns,
                            std::uint64_t in_front) {
    std::vector<const Column*> bound;
    for (const PlyProperty& property : element.properties) {
        bound.push_back(find_column(columns, property.name));
    }
    const char* const end = body_.data() + body_.size();
    for (std::uint64_t row = 0; row < element.count; ++row) {
        for (std::size_t i = 0; i < bound.size(); ++i) {
            const char* at = body_.data() + at_;
            while (at != end && *at == ' ') {
                ++at;
            }
            const PlyProperty& property = element.properties[i];
            if (at == end || *at == '\n') {
                fail(row_name(element, in_front + row),
                     std::string(at == end ? "the file" : "the line") + " ends before "
                         + property.name + ", expected " + std::to_string(bound.size())
                         + " numbers a line");
            }
            char* target = bound[i] == nullptr ? nullptr : bound[i]->data + row * bound[i]->stride;
            const char* next = parse_number(at, end, property.type, target);
            if (next == nullptr || (next != end && *next != ' ' && *next != '\n')) {
                const std::string_view rest(at, static_cast<std::size_t>(end - at));
                fail(row_name(element, in_front + row),
                     property.name + " is " + printable(rest.substr(0, rest.find_first_of(" \n")))
                         + ", expected a number of type " + std::string(name_of(property.type)));
            }
            at_ = static_cast<std::size_t>(next - body_.data());
        }
        const std::size_t line_end = body_.find_first_not_of(' ', at_);
        if (line_end == std::string_view::npos || body_[line_end] != '\n') {
            fail(row_name(element, in_front + row),
                 line_end == std::string_view::npos
                     ? "the file ends here, expected a newline"
                     : "more than " + std::to_string(bound.size()) + " numbers on the line");
        }
        at_ = line_end + 1;
    }
}

void BodyReader::skip_binary(const PlyElement& element) {
    for (std::uint64_t row = 0; row < element.count; ++row) {
        for (const PlyProperty& property : element.properties) {
            std::uint64_t count = 1;
            if (property.count_type) {
                const std::size_t bytes = size_of(*property.count_type);
                if (body_.size() - at_ < bytes) {
                    fail(row_name(element, row), "the file ends here: it is truncated");
                }
                count = list_length(body_.data() + at_, *property.count_type);
                at_ += bytes;
            }
            if (count > (body_.size() - at_) / size_of(property.type)) {
                fail(row_name(element, row),
                     "the file ends within property " + property.name + ": it is truncated");
            }
            at_ += count * size_of(property.type);
        }
    }
}

void BodyReader::skip_ascii(const PlyElement& element) {
    for (std::uint64_t row = 0; row < element.count; ++row) {
        const std::size_t line_end = body_.find('\n', at_);
        if (line_end == std::string_view::npos) {
            fail(row_name(element, row), "the file ends here: it is truncated");
        }
        at_ = line_end + 1;
    }
}

void BodyReader::finish() {
    for (; next_element_ < header_.elements.size(); ++next_element_) {
        if (header_.info.encoding == Encoding::Ascii) {
            skip_ascii(header_.elements[next_element_]);
        } else {
            skip_binary(header_.elements[next_element_]);
        }
    }
    if (at_ != body_.size()) {
        fail("end of file",
             std::to_string(body_.size() - at_) + " bytes follow the last element, expected none");
    }
    if (header_.info.encoding == Encoding::Ascii) {
        check_checksum();
    }
}

bool has_property(const PlyElement& element,
                  std::string_view name,
                  PlyType type,
                  const std::filesystem::path& path) {
    for (const PlyProperty& property : element.properties) {
        if (property.name == name) {
            if (property.type != type) {
                throw Error(path.string() + ": header: property " + property.name + " of element "
                            + element.name + " is " + std::string(name_of(property.type))
                            + ", expected " + std::string(name_of(type)));
            }
            return true;
        }
    }
    return false;
}

bool has_vector(const PlyElement& element,
                int dimension,
                std::string_view prefix,
                std::string_view what,
                const std::filesystem::path& path) {
    int found = 0;
    for (const char axis :
         std::string_view("xyzw").substr(0, static_cast<std::size_t>(dimension))) {
        found += has_property(element, std::string(prefix) + axis, PlyType::Double, path) ? 1 : 0;
    }
    if (found != 0 && found != dimension) {
        throw Error(path.string() + ": header: " + std::to_string(found) + " " + std::string(what)
                    + " properties, expected none or all of " + std::to_string(dimension));
    }
    return found != 0;
}

std::uint32_t write_file(const std::filesystem::path& path,
                         Header header,
                         const std::string& body,
                         const SlabWriters* writers) {
    constexpr std::size_t kMost = kLongestLine - std::string_view("comment created_by ").size();
    if (header.info.created_by.size() > kMost) {
        throw Error(path.string() + ": created_by is longer than a line of a header may be");
    }
    header.info.crc32c = crc32c_of_slabs(writers, body);
    write_slabs(path, format_header(header), body, writers);
    return header.info.crc32c;
}

PlyElement make_element(std::string_view name,
                        std::uint64_t count,
                        const std::vector<Column>& columns) {
    PlyElement element{std::string(name), count, {}};
    for (const Column& column : columns) {
        element.properties.push_back({column.name, column.type, std::nullopt});
    }
    return element;
}

}  // namespace pent
