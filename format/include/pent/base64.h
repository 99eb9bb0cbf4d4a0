#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace pent {

/// Bytes as base64: text of 64 characters, padded with '=' (RFC 4648).
[[nodiscard]] std::string to_base64(std::string_view bytes);

/// The bytes of such a text; nothing if it is no base64.
[[nodiscard]] std::optional<std::string> from_base64(std::string_view text);

/// Decodes such texts one behind the other, each with its own padding and with white space
/// anywhere, until `bytes` bytes are there, or up to two more, or the text ends; nothing if what
/// was read up to there is no base64.
[[nodiscard]] std::optional<std::string> from_base64_prefix(std::string_view text,
                                                            std::size_t bytes);

}  // namespace pent
