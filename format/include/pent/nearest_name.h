#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pent {

/// The known name that was probably meant by a word: the nearest one in edit distance (insertions,
/// deletions and replacements of letters), the first of equals. "" if none is within half as many
/// edits as the word has letters, or two.
[[nodiscard]] std::string nearest_name(std::string_view word,
                                       const std::vector<std::string>& known);

}  // namespace pent
