#include "pent/viewer/render_run.h"

#include "run_renderer.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/output_file.h>
#include <pent/viewer/image.h>
#include <pent/viewer/movie.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <utility>

namespace pent::viewer {

namespace {

constexpr int kLeastPixels = 16;
constexpr int kSheetGap = 6;  // pixels
const Color kSheetPaper(0.9F, 0.9F, 0.9F);

void check(const RenderTargets& targets, const RenderRunOptions& options) {
    const std::string size = std::to_string(options.width) + "x" + std::to_string(options.height);
    if (std::min(options.width, options.height) < kLeastPixels
        || std::max(options.width, options.height) > 8192) {
        throw Error("pictures: found size " + size + "; expected 16 to 8192 each way");
    }
    const SectionOptions& sections = options.sections;
    const std::size_t tiles = options.is_onion || options.is_sweep
                                  ? 1
                                  : std::max<std::size_t>(sections.offsets.size(), 1)
                                        * std::max<std::size_t>(sections.last_angles.size(), 1);
    if (std::cmp_less(options.width, kLeastPixels * tiles)) {
        throw Error("pictures: found " + std::to_string(tiles) + " hyperplanes side by side in "
                    + std::to_string(options.width)
                    + " pixels; expected 16 pixels each: take fewer, wider pictures, onion skin or"
                      " a sweep");
    }
    if (!targets.movie.empty() && (options.width % 2 != 0 || options.height % 2 != 0)) {
        throw Error("pictures: found size " + size + "; a movie needs even numbers");
    }
    if (options.is_onion && options.is_sweep) {
        throw Error("pictures: found both onion skin and sweep; give one of them");
    }
    if (!targets.picture.empty() && options.is_sweep) {
        throw Error(targets.picture.string()
                    + ": one picture cannot hold a sweep; choose a folder, a movie or a sheet");
    }
    if (!targets.picture.empty() && options.frames.size() != 1) {
        throw Error(targets.picture.string() + ": one picture cannot hold "
                    + std::to_string(options.frames.size())
                    + " frames; choose one, a folder, a movie or a contact sheet");
    }
}

// Up to `count` of the frames, evenly spread, the first and the last among them.
std::vector<int> spread(const std::vector<int>& frames, int count) {
    const std::size_t kept = std::min(frames.size(), static_cast<std::size_t>(std::max(count, 1)));
    std::vector<int> result;
    for (std::size_t i = 0; i < kept; ++i) {
        result.push_back(frames[kept == 1 ? 0 : i * (frames.size() - 1) / (kept - 1)]);
    }
    return result;
}

std::string picture_name(int frame) {
    return formatted("%06d.png", frame);
}

std::string sweep_picture_name(int frame, std::size_t section) {
    return formatted("%06d_s%02zu.png", frame, section);
}

// Finds out before all the work whether the files can be made at all, and makes their folders.
void try_outputs(const RenderTargets& targets) {
    for (const std::filesystem::path& path : {targets.movie, targets.picture, targets.sheet}) {
        if (!path.empty()) {
            if (path.has_parent_path()) {
                make_folder(path.parent_path());
            }
            const OutputFile attempt(path);
        }
    }
}

template <int Dim>
bool look_at_frames(RunRenderer<Dim>& renderer,
                    const RenderRunOptions& options,
                    const OnProgress& on_progress) {
    const auto total = static_cast<std::int64_t>(options.frames.size());
    std::int64_t done = 0;
    for (const int frame : options.frames) {
        if (!on_progress("looked at frame", done++, total)) {
            return false;
        }
        renderer.look_at(frame);
    }
    (void)on_progress("looked at frame", done, total);
    renderer.settle();
    return true;
}

template <int Dim>
bool render_frames(const RunRenderer<Dim>& renderer,
                   const RenderTargets& targets,
                   const RenderRunOptions& options,
                   const OnProgress& on_progress,
                   RenderRunReport& report) {
    std::unique_ptr<Movie> movie;
    if (!targets.movie.empty()) {
        movie = std::make_unique<Movie>(targets.movie, options.width, options.height,
                                        report.frames_per_second);
    }
    const std::size_t shots = options.is_sweep ? renderer.tile_count() : 1;
    const auto total = static_cast<std::int64_t>(options.frames.size() * shots);
    std::int64_t done = 0;
    for (const int frame : options.frames) {
        for (std::size_t shot = 0; shot < shots; ++shot) {
            if (!on_progress("picture", done++, total)) {
                return false;
            }
            const Image image =
                options.is_sweep ? renderer.tile_picture(frame, shot) : renderer.picture(frame);
            ++report.pictures;
            if (movie) {
                movie->add(image);
            }
            if (!targets.picture.empty()) {
                write_png(targets.picture, image);
                report.files.push_back(targets.picture.string());
            }
            if (!targets.folder.empty()) {
                write_png(targets.folder
                              / (options.is_sweep ? sweep_picture_name(frame, shot)
                                                  : picture_name(frame)),
                          image);
            }
        }
    }
    (void)on_progress("picture", done, total);
    if (movie) {
        movie->finish();
        report.files.push_back(targets.movie.string());
    }
    if (!targets.folder.empty()) {
        report.files.push_back(targets.folder.string());
    }
    return true;
}

// A row for each tile of a picture. The frames of a single tile fill a square, and so do the tiles
// of a single frame.
template <int Dim>
bool render_sheet(const RunRenderer<Dim>& renderer,
                  const RenderTargets& targets,
                  const RenderRunOptions& options,
                  const OnProgress& on_progress,
                  RenderRunReport& report) {
    const std::vector<int> frames = spread(options.frames, options.sheet_frames);
    const auto total = static_cast<std::int64_t>(frames.size() * renderer.tile_count());
    std::vector<Image> tiles;
    for (std::size_t tile = 0; tile < renderer.tile_count(); ++tile) {
        for (const int frame : frames) {
            if (!on_progress("sheet picture", static_cast<std::int64_t>(tiles.size()), total)) {
                return false;
            }
            tiles.push_back(renderer.small_tile(frame, tile));
            ++report.pictures;
        }
    }
    (void)on_progress("sheet picture", total, total);
    const bool is_table = frames.size() > 1 && renderer.tile_count() > 1;
    const auto columns = static_cast<int>(
        is_table ? frames.size() : static_cast<std::size_t>(std::ceil(std::sqrt(tiles.size()))));
    const Image sheet = contact_sheet(tiles, columns, kSheetGap, kSheetPaper);
    write_png(targets.sheet, stacked(sheet, renderer.sheet_legend(sheet.width, kSheetPaper)));
    report.files.push_back(targets.sheet.string());
    return true;
}

// Of the movie, if there is to be one.
template <int Dim>
double rate_of(const RunRenderer<Dim>& renderer,
               const RenderTargets& targets,
               const RenderRunOptions& options) {
    const double rate = options.frames_per_second.value_or(renderer.true_rate());
    if (!targets.movie.empty() && !(rate >= 0.1 && rate <= 1000)) {
        throw Error(targets.movie.string()
                    + formatted(": true speed is %.4g pictures a second; expected 0.1 to 1000: "
                                "choose a rate (--fps), or other frames",
                                rate));
    }
    return rate;
}

template <int Dim>
RenderRunReport render_run_in(const RunFolder& run,
                              const RenderTargets& targets,
                              const RenderRunOptions& options,
                              const OnProgress& on_progress) {
    if (Dim == 3 && options.projection) {
        throw Error("pictures: the bodies have dimension 3; there is nothing to project");
    }
    RunRenderer<Dim> renderer(run, options);
    if (!targets.folder.empty()) {
        make_folder(targets.folder);
    }
    const bool has_frames =
        !targets.movie.empty() || !targets.picture.empty() || !targets.folder.empty();
    const bool has_sheet = !targets.sheet.empty();
    RenderRunReport report;
    report.frames_per_second = rate_of(renderer, targets, options);
    if (!look_at_frames(renderer, options, on_progress)) {
        return report;
    }
    report.is_empty = renderer.is_empty();
    report.range = renderer.range();
    report.is_complete =
        (!has_sheet || render_sheet(renderer, targets, options, on_progress, report))
        && (!has_frames || render_frames(renderer, targets, options, on_progress, report));
    return report;
}

}  // namespace

RenderRunReport render_run(const RunFolder& run,
                           const RenderTargets& targets,
                           const RenderRunOptions& options,
                           const OnProgress& on_progress) {
    check(targets, options);
    try_outputs(targets);
    return run.dimension == 4 ? render_run_in<4>(run, targets, options, on_progress)
                              : render_run_in<3>(run, targets, options, on_progress);
}

}  // namespace pent::viewer
