#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace pent::viewer {

/// Where in the page a run may be put.
inline constexpr std::string_view kRunMark = "<!-- run -->";

/// The page as scripts/web.sh builds it. Throws an Error if it is not there, or is another.
[[nodiscard]] std::string read_web_page(const std::filesystem::path& path);

}  // namespace pent::viewer
