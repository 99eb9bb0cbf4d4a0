#pragma once

#include <pent/viewer/camera.h>
#include <pent/viewer/coloring.h>
#include <pent/viewer/project.h>
#include <pent/viewer/run_folder.h>
#include <pent/viewer/section.h>
#include <pent/viewer/slice_run.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pent::viewer {

struct RenderRunOptions {
    SectionOptions sections;  ///< Several are shown side by side unless a flag below says more.
    std::vector<int> frames;  ///< Out of run.frames; at least one.
    int width = 1280;         ///< Of a whole picture, pixels, 16..8192.
    int height = 720;         ///< The same.
    ColorBy color = ColorBy::Body;
    std::optional<ColorRange> range;  ///< Of the color bar; none: that of the frames.
    /// Show the outlines of the whole bodies as ghosts around the slices.
    std::optional<ProjectionOptions> projection;
    bool is_onion = false;  ///< All hyperplanes in one picture, all but the middle one as ghosts.
    bool is_sweep = false;  ///< One picture after the other for each hyperplane, at every frame.
    ViewOptions view;
    bool has_obstacles = true;  ///< Show those of the scene, sliced as the bodies are.
    /// A floor under the lowest point, for the shadows, where no obstacle is one.
    bool has_floor = true;
    bool has_caption = true;  ///< Time, hyperplane and color bar.
    /// Of the movie, 0.1..1000; none: as in the simulation, so that it plays at its true speed.
    std::optional<double> frames_per_second;
    int sheet_frames = 6;  ///< On a contact sheet, evenly spread, at most; at least 1.
};

/// Where pictures go; any of them may be empty.
struct RenderTargets {
    std::filesystem::path movie{};    ///< .mp4
    std::filesystem::path picture{};  ///< .png of the only frame
    std::filesystem::path folder{};   ///< 000123.png for every frame; 000123_s01.png in a sweep
    std::filesystem::path
        sheet{};  ///< .png: several frames, with several hyperplanes a row for each
};

struct RenderRunReport {
    std::int64_t pictures = 0;     ///< Rendered.
    bool is_complete = false;      ///< False if on_progress ended it; then no movie is left.
    bool is_empty = false;         ///< No hyperplane meets a body in any frame.
    ColorRange range;              ///< Of the color bar.
    double frames_per_second = 0;  ///< Of the movie.
    std::vector<std::string> files;
};

/// Renders frames of a run: slices in light and shade, one camera that sees all of every frame.
///
/// Folders of pictures are made if need be. Obstacles are gray: balls as bodies are; planes and
/// hollows where they face the eye, and what the rim of a hollow hides shows through. Those that
/// are no larger than the bodies' reach are in the picture whole.
///
/// Throws an Error as reading and writing do, for a size that is out of range or, for a movie, odd,
/// and for several frames in one picture.
[[nodiscard]] RenderRunReport render_run(const RunFolder& run,
                                         const RenderTargets& targets,
                                         const RenderRunOptions& options,
                                         const OnProgress& on_progress);

}  // namespace pent::viewer
