#pragma once

#include <string>

namespace pent {

/// A text as one field of a row of comma-separated values (RFC 4180): as it is or, where commas,
/// quotes or line breaks in it would be taken for those of the table, in quotes.
[[nodiscard]] inline std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) {
        return text;
    }
    std::string quoted = "\"";
    for (const char c : text) {
        quoted += c == '"' ? "\"\"" : std::string(1, c);
    }
    return quoted + "\"";
}

}  // namespace pent
