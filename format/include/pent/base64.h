#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace pent {

/// Bytes as text of 64 characters, padded with '=' (RFC 4648).
[[nodiscard]] std::string to_base64(std::string_view bytes);

/// The bytes of such a text; nothing if it is none.
[[nodiscard]] std::optional<std::string> from_base64(std::string_view text);

/// The first bytes of such texts one behind the other, with white space anywhere: as many as asked
/// for, or up to two more, or fewer where the text ends; nothing if it is none up to there.
[[nodiscard]] std::optional<std::string> from_base64_prefix(std::string_view text,
                                                            std::size_t bytes);

}  // namespace pent
