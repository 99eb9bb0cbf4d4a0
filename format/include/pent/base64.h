#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace pent {

/// Bytes as text of 64 characters, padded with '=' (RFC 4648).
[[nodiscard]] std::string to_base64(std::string_view bytes);

/// The bytes of such a text; nothing if it is none.
[[nodiscard]] std::optional<std::string> from_base64(std::string_view text);

}  // namespace pent
