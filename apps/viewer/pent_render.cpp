#include "common/program.h"
#include "common/values.h"
#include "view_options.h"

#include <pent/error.h>
#include <pent/input_path.h>
#include <pent/viewer/movie.h>
#include <pent/viewer/render_run.h>
#include <pent/viewer/run_folder.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

namespace pent::apps {

namespace {

constexpr const char* kPictures = R"(\d{6,}(_s\d{2,})?\.png)";  // names of those in a folder

struct Arguments {
    ViewArguments view;
    std::string output;
    std::string sheet;
    std::string size = "1280x720";
    std::string range;
    bool no_floor = false;
    bool no_obstacles = false;
    bool no_caption = false;
    viewer::RenderRunOptions render;
};

// Where the pictures are of a command that was stopped, and what there is not.
std::string left_by(const viewer::RenderRunReport& report, const viewer::RenderTargets& targets) {
    std::string line;
    for (const std::filesystem::path& whole : {targets.sheet, targets.movie, targets.picture}) {
        const bool is_there =
            std::find(report.files.begin(), report.files.end(), whole) != report.files.end();
        line += whole.empty() || is_there ? "" : "; " + whole.string() + " is not written";
    }
    return line + (targets.folder.empty() ? "" : "; frames are in " + targets.folder.string());
}

void add_options(CLI::App& cli, Arguments& arguments) {
    add_view_options(cli, arguments.view);
    viewer::RenderRunOptions& render = arguments.render;
    cli.add_option("-o,--output", arguments.output,
                   "movie.mp4 (made by ffmpeg), picture.png of one frame, or a folder of pictures")
        ->type_name("OUT");
    cli.add_option(
           "--sheet", arguments.sheet,
           "A contact sheet, PNG: several frames, a row for each slice if there are several")
        ->type_name("FILE");
    cli.add_option("--sheet-frames", render.sheet_frames, "Frames on the sheet; default: 6")
        ->check(whole_number(1, 100));
    cli.add_option("--size", arguments.size, "Pixels of a picture; default: 1280x720")
        ->type_name("WxH");
    cli.add_option("--fps", render.frames_per_second,
                   "Pictures a second of the movie; default: as in the simulation")
        ->check(number(0.1, 1000.0));
    cli.add_option("--azimuth", render.view.azimuth,
                   "Where the camera stands, degrees about y; default: 30")
        ->check(number(-3600.0, 3600.0));
    cli.add_option("--elevation", render.view.elevation,
                   "How far the camera looks down, degrees; default: 18")
        ->check(number(-89.0, 89.0));
    cli.add_option("--fov", render.view.field_of_view,
                   "What the camera sees from top to bottom, degrees; default: 28")
        ->check(number(1.0, 150.0));
    cli.add_flag("--onion", render.is_onion,
                 "Show several slices in one picture, all but the middle one as ghosts");
    cli.add_flag("--sweep", render.is_sweep,
                 "Show several slices one after the other, at every frame: a mesh from end to end");
    cli.add_option("--range", arguments.range, "Values of the first and last color, LOW,HIGH")
        ->type_name("A,B");
    cli.add_flag("--no-obstacles", arguments.no_obstacles, "Leave out the obstacles of the scene");
    cli.add_flag("--no-floor", arguments.no_floor,
                 "Leave out the floor drawn where no obstacle is one, and its shadows");
    cli.add_flag("--no-caption", arguments.no_caption, "Leave out time, slice and color bar");
}

// "1280x720" as its two numbers, or nothing.
std::optional<std::pair<int, int>> to_size(const std::string& text) {
    int width = 0;
    int height = 0;
    const char* end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, width);
    if (first.ec != std::errc() || first.ptr == end || *first.ptr != 'x') {
        return std::nullopt;
    }
    const auto second = std::from_chars(first.ptr + 1, end, height);
    if (second.ec != std::errc() || second.ptr != end) {
        return std::nullopt;
    }
    return std::pair(width, height);
}

void read_size(const std::string& text, viewer::RenderRunOptions& render) {
    const auto size = to_size(text);
    if (!size) {
        throw Error("--size: found \"" + text + "\"; expected WIDTHxHEIGHT, as in 1280x720");
    }
    std::tie(render.width, render.height) = *size;
}

viewer::ColorRange to_color_range(const std::string& text) {
    const std::vector<double> ends = to_numbers(text, "--range");
    if (ends.size() != 2 || !(ends[0] < ends[1])) {
        throw Error("--range: found \"" + text + "\"; expected LOW,HIGH with LOW below HIGH");
    }
    return {ends[0], ends[1]};
}

bool has_extension(const std::string& path, const std::string& extension) {
    return format_of(path, "") == extension;
}

// Where the pictures go; a movie falls back to a folder of pictures where there is no ffmpeg.
viewer::RenderTargets to_targets(const Program& program, const Arguments& arguments) {
    viewer::RenderTargets targets;
    targets.sheet = arguments.sheet;
    const std::string& output = arguments.output;
    if (output.empty() && arguments.sheet.empty()) {
        throw Error(
            "pictures: nothing to make; give -o movie.mp4, -o picture.png, -o FOLDER or "
            "--sheet FILE.png");
    }
    if (!arguments.sheet.empty() && !has_extension(arguments.sheet, ".png")) {
        throw Error("--sheet: found " + arguments.sheet + "; expected a name that ends in .png");
    }
    std::error_code ignored;  // of names too long to be there
    const bool is_folder = output.empty() || output.back() == '/'
                           || !std::filesystem::path(output).has_extension()
                           || std::filesystem::is_directory(output, ignored);
    if (!is_folder && !has_extension(output, ".mp4") && !has_extension(output, ".png")) {
        throw Error("--output: found " + output
 + "; expected a name that ends in .mp4 or .png, or a folder (with / at its end "
 "if there is a dot in its name)");
    }
    if (has_extension(output, ".mp4") && viewer::Movie::is_possible()) {
        targets.movie = output;
    } else if (has_extension(output, ".mp4")) {
        targets.folder = output.substr(0, output.size() - 4) + "_pictures";
        program.say("no ffmpeg to make " + output + ": pictures go to " + targets.folder.string()
                    + " instead (install ffmpeg for a movie)");
    } else if (has_extension(output, ".png")) {
        targets.picture = output;
    } else {
        targets.folder = output;
    }
    return targets;
}

Verdict render(Program& program, Arguments& arguments) {
    const std::vector<NamedFile> inputs = inputs_of(arguments.view.input);
    program.require_apart(inputs, {});  // before an error is reported there
    const viewer::RunFolder run = viewer::open_run(arguments.view.input);
    viewer::RenderRunOptions& options = arguments.render;
    options.sections = to_sections(arguments.view);
    const viewer::RenderTargets targets = to_targets(program, arguments);
    program.require_apart(inputs, {{"--output", targets.movie},
                                   {"--output", targets.picture},
                                   {"--output", targets.folder},
                                   taken_name(program.common().json, targets.folder, kPictures),
                                   taken_name(targets.sheet, targets.folder, kPictures),
                                   {"--sheet", targets.sheet}});
    const bool is_one_picture = !targets.picture.empty() && targets.sheet.empty();
    options.frames = viewer::select_frames(
        run.frames,
        is_one_picture && arguments.view.frames.empty() ? "last" : arguments.view.frames);
    options.color = viewer::coloring_of(arguments.view.color);
    options.projection = to_projection(arguments.view);
    options.has_floor = !arguments.no_floor;
    options.has_obstacles = !arguments.no_obstacles;
    options.has_caption = !arguments.no_caption;
    read_size(arguments.size, options);
    if (!arguments.range.empty()) {
        options.range = to_color_range(arguments.range);
    }

    WorkProgress progress(program.common().quiet);
    const viewer::RenderRunReport report =
        viewer::render_run(run, targets, options, std::ref(progress));
    progress.finish();

    program.report()["frames"] = options.frames.size();
    program.report()["pictures"] = report.pictures;
    program.report()["files"] = report.files;
    std::string line = std::string(report.is_complete ? "finished" : "stopped") + ": "
                       + std::to_string(report.pictures)
                       + (report.pictures == 1 ? " picture" : " pictures");
    for (const std::string& file : report.files) {
        line += (&file == &report.files.front() ? " in " : ", ") + file;
    }
    line += report.is_complete ? "" : left_by(report, targets);
    if (options.color != viewer::ColorBy::Body) {
        line += "; " + viewer::title_of(options.color, run.dimension) + ": "
                + viewer::short_number(report.range.low) + " to "
                + viewer::short_number(report.range.high);
    }
    program.say(line + (report.is_empty ? " (the hyperplane misses the bodies)" : ""));
    return report.is_complete ? Verdict::Finished : Verdict::Stopped;
}

}  // namespace

}  // namespace pent::apps

int main(int argc, char** argv) {
    pent::apps::Program program(
        "pent-render", "Renders pictures and movies of slices of four-dimensional bodies.",
        "pent-render RUN/ -o movie.mp4 --sheet sheet.png --w -0.1,0,0.1 --color strain");
    pent::apps::Arguments arguments;
    add_options(program.options(), arguments);
    return program.run(argc, argv, [&] { return render(program, arguments); });
}
