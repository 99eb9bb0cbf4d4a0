#pragma once

#include <string>

namespace pent {

/// What printf would write, as a string: formatted("%.3g m", 0.25) is "0.25 m". Any length; the
/// compiler checks the values against the format.
[[nodiscard]] std::string formatted(const char* format, ...) __attribute__((format(printf, 1, 2)));

}  // namespace pent
