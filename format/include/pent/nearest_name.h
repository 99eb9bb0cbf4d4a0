#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pent {

/// The known name that was probably meant by a word that is not one: the nearest by insertions,
/// deletions and replacements of letters, the first of equals. "" if none is within half the
/// letters of the word (or two).
[[nodiscard]] std::string nearest_name(std::string_view word,
                                       const std::vector<std::string>& known);

}  // namespace pent
