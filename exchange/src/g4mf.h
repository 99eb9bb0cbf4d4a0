#pragma once

#include <cstddef>
#include <string_view>

namespace pent::exchange::g4mf {

inline constexpr std::string_view kMagic = "G4MF";
inline constexpr std::string_view kDataUri = "data:application/octet-stream;base64,";
inline constexpr std::size_t kHeader = 16;  ///< Bytes, of a file and of a chunk.

}  // namespace pent::exchange::g4mf
