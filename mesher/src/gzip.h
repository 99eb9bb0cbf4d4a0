#pragma once

#include <string>
#include <string_view>

namespace pent::mesher {

/// Whether bytes begin as those of gzip do.
[[nodiscard]] bool is_gzip(std::string_view bytes);

/// The first `most` bytes of what gzip packed, or all if there are fewer. Memory grows with what
/// comes out, whatever the file says.
///
/// Throws an Error that begins with `name` for bytes that are damaged or end too soon.
[[nodiscard]] std::string unpack_gzip(std::string_view bytes,
                                      std::size_t most,
                                      const std::string& name);

}  // namespace pent::mesher
