#pragma once

#include <string>
#include <string_view>

namespace pent {

/// Text as a terminal may be given it: bytes that are not UTF-8, and control characters but for the
/// newline and the tab, become \x and two hexadecimal digits.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace pent
