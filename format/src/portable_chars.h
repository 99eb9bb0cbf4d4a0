#pragma once

#include <charconv>

namespace pent {

/// The functions of real_text.h by strtod and printf alone; several times slower than the standard
/// ones. For float and double.
template <typename Real>
[[nodiscard]] std::to_chars_result portable_to_chars(char* first, char* last, Real value);
template <typename Real>
[[nodiscard]] std::from_chars_result portable_from_chars(const char* first,
                                                         const char* last,
                                                         Real& value);

}  // namespace pent
