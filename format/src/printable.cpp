#include "pent/printable.h"

#include <pent/formatted.h>

#include <cstdint>

namespace pent {

namespace {

// Bytes of the character at the start of the text: 0 if it is none of UTF-8, as for surrogates, for
// what is beyond U+10FFFF, and for longer forms of what has a shorter one [RFC 3629].
std::size_t length_of_character(std::string_view text) {
    const auto byte = [&](std::size_t i) -> std::uint32_t {
        return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
    };
    const std::uint32_t first = byte(0);
    if (first < 0x80) {
        return 1;
    }
    const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
    std::uint32_t code = first & (0xffU >> (length + 1));
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xc0) != 0x80) {
            return 0;
        }
        code = code << 6 | (byte(i) & 0x3f);
    }
    constexpr std::uint32_t kLowest[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool is_surrogate = code >= 0xd800 && code < 0xe000;
    return first < 0xc0 || first > 0xf7 || code < kLowest[length] || code > 0x10ffff || is_surrogate
               ? 0
               : length;
}

// Of ASCII, and those of U+0080 to U+009F, which terminals take for the same.
bool is_control(std::string_view character) {
    const auto first = static_cast<unsigned char>(character[0]);
    return first < 0x20 || first == 0x7f
           || (first == 0xc2 && static_cast<unsigned char>(character[1]) < 0xa0);
}

}  // namespace

std::string printable(std::string_view text) {
    std::string shown;
    while (!text.empty()) {
        const std::size_t length = length_of_character(text);
        const std::string_view character = text.substr(0, length == 0 ? 1 : length);
        const bool is_kept =
            length > 0 && (!is_control(character) || character == "\n" || character == "\t");
        if (is_kept) {
            shown += character;
        } else {
            for (const char byte : character) {
                shown += formatted("\\x%02x", static_cast<unsigned char>(byte));
            }
        }
        text.remove_prefix(character.size());
    }
    return shown;
}

}  // namespace pent
