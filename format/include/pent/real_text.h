#pragma once

#include <charconv>

namespace pent {

/// std::to_chars and std::from_chars for floats and doubles, which not every C++ library has: the
/// same text and the same numbers with each, whatever the locale.

/// Writes the shortest text that reads back as the same number; 24 characters are enough.
[[nodiscard]] std::to_chars_result real_to_chars(char* first, char* last, float value);
[[nodiscard]] std::to_chars_result real_to_chars(char* first, char* last, double value);

/// Reads a number at the begin of [first, last), as std::from_chars does: no space, no plus sign in
/// front; the nearest number, and out of range where there is none.
[[nodiscard]] std::from_chars_result real_from_chars(const char* first,
                                                     const char* last,
                                                     float& value);
[[nodiscard]] std::from_chars_result real_from_chars(const char* first,
                                                     const char* last,
                                                     double& value);

}  // namespace pent
