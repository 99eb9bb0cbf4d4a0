#pragma once

#include <pent/output_file.h>

#include <filesystem>

namespace pent::viewer::test {

/// Writes something that has the place for a run which the page of web/ has.
inline std::filesystem::path write_page(const std::filesystem::path& folder) {
    std::filesystem::path page = folder / "index.html";
    write_text(page, "<!doctype html><body>viewer\n<!-- run -->\n</body>");
    return page;
}

}  // namespace pent::viewer::test
