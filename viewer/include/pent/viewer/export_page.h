#pragma once

#include <pent/viewer/run_folder.h>
#include <pent/viewer/slice_run.h>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace pent::viewer {

struct ExportOptions {
    std::filesystem::path page;            ///< index.html as scripts/web.sh builds it.
    std::vector<int> frames;               ///< Out of run.frames; at least one.
    std::int64_t most_bytes = 64'000'000;  ///< Of the file that is made, over 0.
};

struct ExportReport {
    std::int64_t bytes = 0;    ///< Of the file.
    double largest_error = 0;  ///< Of a coordinate by its rounding, m.
    bool is_complete = false;  ///< False if on_progress ended it; then there is no file.
};

/// Writes a run into one page that opens by a double click, without a server.
///
/// Of each body it holds the boundary alone: positions in 16 bits a coordinate over the box of the
/// whole run, and in 8 bits what all bodies can be colored by, quantities of their meshes once. A
/// run of one mesh has neither speed nor strain nor forces.
///
/// Throws an Error if a frame cannot be read, the page is not that of the viewer, or the file would
/// be larger than most_bytes; then the message says how large, before any work.
[[nodiscard]] ExportReport export_page(const RunFolder& run,
                                       const std::filesystem::path& output,
                                       const ExportOptions& options,
                                       const OnProgress& on_progress);

}  // namespace pent::viewer
