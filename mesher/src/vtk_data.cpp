#include "vtk_data.h"

#include <pent/base64.h>
#include <pent/counted.h>
#include <pent/error.h>
#include <pent/real_text.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>
#include <zlib.h>

namespace pent::mesher {

namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::uint64_t kMaxDeflation = 1040;  // zlib does not make more of a byte

[[noreturn]] void fail(const XmlElement& array,
                       const VtkEncoding& encoding,
                       const std::string& message) {
    throw Error(place_of(array, encoding) + message);
}

// Bytes as they are, or as base64, from a place on.
class Source {
public:
    Source(std::string_view text, bool is_raw) : text_(text), is_raw_(is_raw) {}

    // The first bytes; fewer where it ends or is no base64.
    [[nodiscard]] std::string first(std::size_t bytes) const {
        return is_raw_ ? std::string(text_.substr(0, bytes))
                       : from_base64_prefix(text_, bytes).value_or("");
    }

private:
    std::string_view text_;
    bool is_raw_;
};

// The header's numbers, from the start of the bytes.
std::vector<std::uint64_t> header_words(std::string_view bytes,
                                        std::size_t count,
                                        const VtkEncoding& encoding) {
    const std::size_t size = encoding.has_long_headers ? 8 : 4;
    std::vector<std::uint64_t> words(count, 0);
    for (std::size_t i = 0; i < count; ++i) {
        std::array<char, 8> raw{};
        std::memcpy(raw.data(), bytes.data() + i * size, size);
        if (encoding.is_big_endian) {
            std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(size));
        }
        std::memcpy(&words[i], raw.data(), 8);
    }
    return words;
}

[[noreturn]] void fail_cut(const XmlElement& array, const VtkEncoding& encoding) {
    fail(array, encoding, "its bytes end too soon or are damaged: the file is cut?");
}

std::string plain_bytes(const Source& source,
                        const XmlElement& array,
                        const VtkEncoding& encoding) {
    const std::size_t header = encoding.has_long_headers ? 8 : 4;
    const std::string start = source.first(header);
    if (start.size() < header) {
        fail_cut(array, encoding);
    }
    const std::uint64_t size = header_words(start, 1, encoding)[0];
    if (size > encoding.file_size) {
        fail_cut(array, encoding);
    }
    const std::string all = source.first(header + size);
    if (all.size() < header + size) {
        fail_cut(array, encoding);
    }
    return all.substr(header, size);
}

// Blocks of equal size, but for the last one: their number, the size of one, that of the last where
// it is smaller, the compressed sizes; then the blocks. In base64 these numbers are a text of their
// own, with padding, in front of that of the blocks: from_base64_prefix() reads on behind it.
std::string inflated_bytes(const Source& source,
                           const XmlElement& array,
                           const VtkEncoding& encoding) {
    const std::size_t word = encoding.has_long_headers ? 8 : 4;
    std::string start = source.first(3 * word);
    if (start.size() < 3 * word) {
        fail_cut(array, encoding);
    }
    const std::vector<std::uint64_t> sizes = header_words(start, 3, encoding);
    const std::uint64_t blocks = sizes[0];
    if (blocks > encoding.file_size / word || sizes[2] > sizes[1]) {
        fail_cut(array, encoding);
    }
    const std::size_t header = (3 + blocks) * word;
    start = source.first(header);
    if (start.size() < header) {
        fail_cut(array, encoding);
    }
    const std::vector<std::uint64_t> words = header_words(start, 3 + blocks, encoding);
    std::uint64_t compressed = 0;
    for (std::size_t block = 0; block < blocks; ++block) {
        const std::uint64_t size = words[3 + block];
        if (size > encoding.file_size - std::min<std::uint64_t>(compressed, encoding.file_size)) {
            fail_cut(array, encoding);
        }
        compressed += size;
    }
    const std::string all = source.first(header + compressed);
    if (all.size() < header + compressed) {
        fail_cut(array, encoding);
    }
    std::string result;
    std::size_t at = header;
    for (std::size_t block = 0; block < blocks; ++block) {
        const bool is_partial = block + 1 == blocks && sizes[2] > 0;
        const std::uint64_t size = is_partial ? sizes[2] : sizes[1];
        if (size > words[3 + block] * kMaxDeflation) {
            fail_cut(array, encoding);
        }
        std::string out(size, '\0');
        uLongf written = size;
        const int code =
            uncompress(reinterpret_cast<Bytef*>(out.data()), &written,
                       reinterpret_cast<const Bytef*>(all.data() + at), words[3 + block]);
        if (code != Z_OK || written != size) {
            fail(array, encoding, "a block that zlib cannot read: the file is damaged");
        }
        result += out;
        at += words[3 + block];
    }
    return result;
}

std::string bytes_of(const XmlElement& array, const VtkEncoding& encoding) {
    std::string_view text = array.text;
    bool is_raw = false;
    if (array.attribute("format") == "appended") {
        const std::string_view word = array.attribute("offset");
        std::uint64_t offset = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), offset);
        if (error != std::errc() || end != word.data() + word.size() || word.empty()) {
            fail(array, encoding, "offset " + in_quotes(word) + ", expected a whole number");
        }
        if (offset > encoding.appended.size()) {
            fail_cut(array, encoding);
        }
        text = encoding.appended.substr(offset);
        is_raw = encoding.is_appended_raw;
    }
    const Source source(text, is_raw);
    return encoding.is_compressed ? inflated_bytes(source, array, encoding)
                                  : plain_bytes(source, array, encoding);
}

template <typename Stored, typename Value>
std::vector<Value> decode(const std::string& bytes,
                          const XmlElement& array,
                          const VtkEncoding& encoding) {
    std::vector<Value> values(bytes.size() / sizeof(Stored));
    for (std::size_t i = 0; i < values.size(); ++i) {
        std::array<char, sizeof(Stored)> raw{};
        std::memcpy(raw.data(), bytes.data() + i * sizeof(Stored), sizeof(Stored));
        if (encoding.is_big_endian) {
            std::reverse(raw.begin(), raw.end());
        }
        const auto stored = std::bit_cast<Stored>(raw);
        if constexpr (std::is_integral_v<Value> && std::is_integral_v<Stored>) {
            if (std::cmp_greater(stored, std::numeric_limits<Value>::max())) {
                fail(array, encoding, "found " + std::to_string(stored) + ", which is too large");
            }
        }
        values[i] = static_cast<Value>(stored);
    }
    return values;
}

template <typename Value>
std::vector<Value> from_ascii(const XmlElement& array, const VtkEncoding& encoding) {
    std::vector<Value> values;
    const char* at = array.text.data();
    const char* const end = at + array.text.size();
    // XML has turned the ends of lines into '\n'.
    const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\n'; };
    while (true) {
        while (at != end && is_space(*at)) {
            ++at;
        }
        if (at == end) {
            return values;
        }
        const char* const stop = std::find_if(at, end, is_space);
        Value value{};
        std::from_chars_result result{};
        if constexpr (std::is_integral_v<Value>) {
            result = std::from_chars(at, stop, value);
        } else {
            result = real_from_chars(at, stop, value);
        }
        if (result.ec != std::errc() || result.ptr != stop) {
            fail(array, encoding,
                 "found " + in_quotes({at, static_cast<std::size_t>(stop - at)})
                     + ", expected a number");
        }
        values.push_back(value);
        at = stop;
    }
}

enum class Type { Int8, UInt8, Int16, UInt16, Int32, UInt32, Int64, UInt64, Float32, Float64 };

constexpr std::array<std::pair<std::string_view, Type>, 10> kTypes = {{{"Int8", Type::Int8},
                                                                       {"UInt8", Type::UInt8},
                                                                       {"Int16", Type::Int16},
                                                                       {"UInt16", Type::UInt16},
                                                                       {"Int32", Type::Int32},
                                                                       {"UInt32", Type::UInt32},
                                                                       {"Int64", Type::Int64},
                                                                       {"UInt64", Type::UInt64},
                                                                       {"Float32", Type::Float32},
                                                                       {"Float64", Type::Float64}}};

template <typename Value>
std::vector<Value> decode_as(Type type,
                             const std::string& bytes,
                             const XmlElement& array,
                             const VtkEncoding& encoding) {
    switch (type) {
        case Type::Int8:
            return decode<std::int8_t, Value>(bytes, array, encoding);
        case Type::UInt8:
            return decode<std::uint8_t, Value>(bytes, array, encoding);
        case Type::Int16:
            return decode<std::int16_t, Value>(bytes, array, encoding);
        case Type::UInt16:
            return decode<std::uint16_t, Value>(bytes, array, encoding);
        case Type::Int32:
            return decode<std::int32_t, Value>(bytes, array, encoding);
        case Type::UInt32:
            return decode<std::uint32_t, Value>(bytes, array, encoding);
        case Type::Int64:
            return decode<std::int64_t, Value>(bytes, array, encoding);
        case Type::UInt64:
            return decode<std::uint64_t, Value>(bytes, array, encoding);
        case Type::Float32:
            return decode<float, Value>(bytes, array, encoding);
        default:
            return decode<double, Value>(bytes, array, encoding);
    }
}

template <typename Value>
std::vector<Value> values_of(const XmlElement& array,
                             const VtkEncoding& encoding,
                             std::int64_t count) {
    const std::string_view name = array.attribute("type");
    const auto type = std::find_if(kTypes.begin(), kTypes.end(),
                                   [&](const auto& known) { return known.first == name; });
    if (type == kTypes.end()) {
        fail(array, encoding,
             "type " + in_quotes(name) + ", expected Int8 to UInt64, Float32 or Float64");
    }
    if (std::is_integral_v<
            Value> && (type->second == Type::Float32 || type->second == Type::Float64)) {
        fail(array, encoding, "type " + in_quotes(name) + ", expected whole numbers");
    }
    const std::string_view format = array.attribute("format");
    if (!format.empty() && format != "ascii" && format != "binary" && format != "appended") {
        fail(array, encoding,
             "format " + in_quotes(format) + ", expected ascii, binary or appended");
    }
    std::vector<Value> values =
        format == "binary" || format == "appended"
            ? decode_as<Value>(type->second, bytes_of(array, encoding), array, encoding)
            : from_ascii<Value>(array, encoding);
    if (std::cmp_not_equal(values.size(), count)) {
        fail(array, encoding,
             counted(values.size(), "number", "numbers") + ", expected " + std::to_string(count)
                 + ": the file is cut?");
    }
    return values;
}

}  // namespace

std::string place_of(const XmlElement& array, const VtkEncoding& encoding) {
    return encoding.name + ": line " + std::to_string(array.line) + ": array "
           + in_quotes(array.attribute("Name")) + ": ";
}

VtkEncoding encoding_of(const XmlFile& file, const std::string& name, std::size_t file_size) {
    VtkEncoding encoding;
    encoding.name = name;
    encoding.file_size = file_size;
    encoding.is_big_endian = file.root.attribute("byte_order") == "BigEndian";
    encoding.has_long_headers = file.root.attribute("header_type") == "UInt64";
    const std::string_view compressor = file.root.attribute("compressor");
    if (!compressor.empty() && compressor != "vtkZLibDataCompressor") {
        throw Error(name + ": compressed by " + in_quotes(compressor)
                    + "; expected vtkZLibDataCompressor or none: save it again with one of them");
    }
    encoding.is_compressed = !compressor.empty();
    encoding.appended = file.appended;
    if (const XmlElement* appended = file.root.child("AppendedData")) {
        encoding.is_appended_raw = appended->attribute("encoding") != "base64";
    }
    return encoding;
}

bool has_numbers(const XmlElement& array) {
    return array.name == "DataArray" && array.attribute("type") != "String";
}

std::int64_t components_of(const XmlElement& array, const VtkEncoding& encoding) {
    const std::string_view word = array.attribute("NumberOfComponents");
    if (word.empty()) {
        return 1;
    }
    std::int64_t count = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
    if (error != std::errc() || end != word.data() + word.size() || count < 1 || count > 1000) {
        fail(array, encoding,
             "NumberOfComponents " + in_quotes(word) + ", expected a whole number from 1 to 1000");
    }
    return count;
}

std::vector<double> reals_of(const XmlElement& array,
                             const VtkEncoding& encoding,
                             std::int64_t count) {
    return values_of<double>(array, encoding, count);
}

std::vector<std::int64_t> integers_of(const XmlElement& array,
                                      const VtkEncoding& encoding,
                                      std::int64_t count) {
    return values_of<std::int64_t>(array, encoding, count);
}

}  // namespace pent::mesher
