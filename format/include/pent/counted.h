#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace pent {

/// A number of things as one reads it: counted(1, "vertex", "vertices") is "1 vertex".
[[nodiscard]] std::string counted(std::int64_t count, std::string_view one, std::string_view many);

}  // namespace pent
