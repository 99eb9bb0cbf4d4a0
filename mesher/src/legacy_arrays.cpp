#include "legacy_arrays.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

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
         {"vtkidtype", 4},  // written as int
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

// Types are known in any letters, too.
std::string in_small_letters(std::string_view word) {
    std::string result(word);
    for (char& c : result) {
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return result;
}

}  // namespace

std::string in_capitals(std::string_view word) {
    std::string result(word);
    for (char& c : result) {
        c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    }
    return result;
}

std::string_view LegacyArrays::take_line() {
    const std::string_view rest = text_.rest();
    return text_.take_bytes(std::min(rest.find('\n'), rest.size() - 1) + 1, "a line");
}

std::int64_t LegacyArrays::line_count() {
    return text_.count(text_.next_word("a count"), "a count");
}

std::size_t LegacyArrays::bytes_of(std::string_view type) const {
    const std::optional<std::size_t> size = size_of(in_small_letters(type));
    if (!size) {
        text_.fail("values of type \"" + std::string(type.substr(0, 40))
                   + "\"; expected a type of numbers, as float or int");
    }
    return *size;
}

std::string LegacyArrays::next_name() {
    return decoded(text_.next_word("the name of an array"));
}

bool LegacyArrays::read(const std::string& keyword,
                        std::int64_t rows,
                        std::vector<FileArray>& arrays) {
    if (keyword == "SCALARS") {
        arrays.push_back(read_scalars(rows));
    } else if (const std::int64_t components = components_of(keyword); components > 0) {
        const std::string name = next_name();
        arrays.push_back(read_values(name, components, rows, text_.next_word("a type")));
    } else if (keyword == "TEXTURE_COORDINATES") {
        const std::string name = next_name();
        const std::int64_t dimension = line_count();
        arrays.push_back(read_values(name, dimension, rows, text_.next_word("a type")));
    } else if (keyword == "COLOR_SCALARS") {
        const std::string name = next_name();
        arrays.push_back(read_values(name, line_count(), rows, "unsigned_char"));
    } else if (keyword == "FIELD") {
        read_field(rows, arrays);
    } else if (keyword == "LOOKUP_TABLE") {
        skip_lookup_table();
    } else if (keyword == "METADATA") {
        skip_metadata();
    } else {
        return false;
    }
    return true;
}

void LegacyArrays::skip_field() {
    std::vector<FileArray> arrays;
    read_field(std::nullopt, arrays);
}

FileArray LegacyArrays::read_scalars(std::int64_t rows) {
    const std::string name = next_name();
    const std::string type(text_.next_word("a type"));
    const std::string_view word = text_.word();
    const std::int64_t components = word.empty() ? 1 : text_.count(word, "a number of components");
    const std::string_view keyword = text_.next_word("LOOKUP_TABLE");
    if (in_capitals(keyword) != "LOOKUP_TABLE") {
        text_.fail("found \"" + std::string(keyword.substr(0, 40)) + "\", expected LOOKUP_TABLE");
    }
    text_.skip_line();
    return read_values(name, components, rows, type);
}

// Arrays with a number of rows each, which is that of points or cells where these have them.
void LegacyArrays::read_field(std::optional<std::int64_t> rows, std::vector<FileArray>& arrays) {
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
        if (rows && found != *rows) {
            text_.fail("array " + name.substr(0, 40) + " has " + std::to_string(found)
                       + " rows, expected " + std::to_string(*rows));
        }
        const std::string type(text_.next_word("a type"));
        if (in_small_letters(type) == "string") {
            skip_strings(components * found);
        } else {
            arrays.push_back(read_values(decoded(name), components, found, type));
        }
    }
}

void LegacyArrays::skip_metadata() {
    while (take_line().find_first_not_of(" \t\r\n") != std::string_view::npos) {
    }
}

// Lines of text; or bytes behind their length, whose first two bits say in how many bytes (8, 4, 2
// or 1) it stands.
void LegacyArrays::skip_strings(std::int64_t count) {
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

// A color table, which no array is made of: four numbers a color.
void LegacyArrays::skip_lookup_table() {
    static_cast<void>(text_.next_word("the name of a table"));
    const std::int64_t size = 4 * line_count();
    for (std::int64_t i = 0; i < size; ++i) {
        static_cast<void>(numbers_.is_text() ? text_.number(text_.next_word("a color"), "a color")
                                             : numbers_.real<std::uint8_t>("a color"));
    }
}

FileArray LegacyArrays::read_values(const std::string& name,
                                    std::int64_t components,
                                    std::int64_t rows,
                                    std::string_view written_type) {
    const std::string type = in_small_letters(written_type);
    FileArray array{name, components, {}};
    const std::int64_t count = rows * components;
    if (type == "bit" && !numbers_.is_text()) {
        for (std::int64_t i = 0; i < count; i += 8) {
            const auto byte = static_cast<std::uint8_t>(text_.take_bytes(1, "bits").front());
            for (std::int64_t bit = 7; bit >= std::max<std::int64_t>(8 - (count - i), 0); --bit) {
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

double LegacyArrays::value_of_type(const std::string& type) {
    if (numbers_.is_text() || type == "double") {
        return numbers_.quantity<double>("a number");
    }
    if (type == "float") {
        return numbers_.quantity<float>("a number");
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

}  // namespace pent::mesher
