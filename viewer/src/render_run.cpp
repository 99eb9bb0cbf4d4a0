#include "survey.h"

#include <pent/error.h>
#include <pent/output_file.h>
#include <pent/viewer/attributes.h>
#include <pent/viewer/image.h>
#include <pent/viewer/legend.h>
#include <pent/viewer/movie.h>
#include <pent/viewer/render.h>
#include <pent/viewer/render_run.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

namespace pent::viewer {

namespace {

constexpr double kCrease = 1.0;  // radians: edges of boxes stay sharp, coarse organic shapes smooth
constexpr int kSheetGap = 6;     // pixels
const Color kSheetPaper(0.9F, 0.9F, 0.9F);

void check(const RenderTargets& targets, const RenderRunOptions& options) {
    const std::string size = std::to_string(options.width) + "x" + std::to_string(options.height);
    if (std::min(options.width, options.height) < 16
        || std::max(options.width, options.height) > 16384) {
        throw Error("pictures: found size " + size + "; expected 16 to 16384 each way");
    }
    if (!targets.movie.empty() && (options.width % 2 != 0 || options.height % 2 != 0)) {
        throw Error("pictures: found size " + size + "; a movie needs even numbers");
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
    char text[32];
    std::snprintf(text, sizeof text, "%06d.png", frame);
    return text;
}

template <int Dim>
Eigen::Matrix<double, 3, Dim> picture_axes(const Section& section) {
    return section.plane.frame.topLeftCorner<3, Dim>();
}

template <int Dim>
class Studio {
public:
    Studio(const RunFolder& run, const RenderRunOptions& options)
        : run_(run),
          options_(options),
          bodies_(load_bodies<Dim>(run)),
          sections_(sections_at_start<Dim>(run, bodies_, options.sections)) {}

    // Looks at all frames first; false if ended early.
    [[nodiscard]] bool prepare(const std::function<bool()>& go_on) {
        CameraFit tile(aspect(tile_width(0), options_.height), options_.view);
        CameraFit whole(aspect(options_.width, options_.height), options_.view);
        survey_ = survey<Dim>(
            run_, bodies_, sections_, options_.frames, options_.color,
            [&](const Surface& surface) {
                tile.add(surface.positions);
                whole.add(surface.positions);
            },
            go_on);
        tile_camera_ = tile.camera();
        sheet_camera_ = whole.camera();
        if (options_.range) {
            survey_.range = *options_.range;
        }
        return survey_.is_complete;
    }

    [[nodiscard]] const Survey& seen() const { return survey_; }
    [[nodiscard]] std::size_t section_count() const { return sections_.size(); }

    // One frame, all sections side by side.
    [[nodiscard]] Image picture(int frame) const {
        const auto count = static_cast<int>(sections_.size());
        Image image(options_.width, options_.height);
        const std::vector<Frame<Dim>> moment = load(frame);
        int left = 0;
        for (int s = 0; s < count; ++s) {
            const int width = tile_width(s);
            paste(image, tile(moment, sections_[s], tile_camera_, width, options_.height), left, 0);
            left += width;
        }
        if (options_.has_caption && options_.color != ColorBy::Body) {
            draw_color_bar(image, Font(caption_pixels(options_.height)),
                           color_map_of(options_.color), survey_.range, title_of(options_.color));
        }
        return image;
    }

    // One section of one frame for a contact sheet.
    [[nodiscard]] Image sheet_tile(int frame, std::size_t section) const {
        return tile(load(frame), sections_[section], sheet_camera_, options_.width * 3 / 8,
                    options_.height * 3 / 8);
    }

private:
    [[nodiscard]] std::vector<Frame<Dim>> load(int frame) const {
        std::vector<Frame<Dim>> moment;
        for (const Body<Dim>& body : bodies_) {
            moment.push_back(load_frame<Dim>(run_, body, frame));
        }
        return moment;
    }

    [[nodiscard]] RenderObject object(std::size_t body,
                                      const Frame<Dim>& frame,
                                      const Section& section) const {
        const Surface surface = take_section<Dim>(bodies_[body], frame.positions, section);
        const Eigen::VectorXd values =
            interpolate(surface, vertex_values<Dim>(bodies_[body], frame, options_.color));
        RenderObject object;
        object.positions = surface.positions;
        object.triangles = surface.triangles;
        object.normals = corner_normals<Dim>(surface, bodies_[body].boundary, frame.positions,
                                             picture_axes<Dim>(section), kCrease);
        object.colors = surface_colors(values, options_.color, survey_.range, body);
        return object;
    }

    [[nodiscard]] Image tile(const std::vector<Frame<Dim>>& moment,
                             const Section& section,
                             const Camera& camera,
                             int width,
                             int height) const {
        std::vector<RenderObject> objects;
        for (std::size_t body = 0; body < bodies_.size(); ++body) {
            objects.push_back(object(body, moment[body], section));
        }
        RenderOptions render;
        render.width = width;
        render.height = height;
        if (!survey_.box.isEmpty()) {
            render.scene_size = std::max(survey_.box.diagonal().norm(), 1e-12);
            render.scene_center = survey_.box.center();
            if (options_.has_floor) {
                render.floor = survey_.box.min().y() - 2e-3 * render.scene_size;
            }
        }
        Image image = renderer_.render(objects, camera, render);
        if (options_.has_caption) {
            std::string line = "t = " + seconds(moment.front().time) + " s";
            line += section.label.empty() ? "" : "    " + section.label;
            draw_caption(image, Font(caption_pixels(height)), line);
        }
        return image;
    }

    [[nodiscard]] static double aspect(int width, int height) {
        return static_cast<double>(width) / height;
    }

    // Sections share the width of a picture, to the pixel.
    [[nodiscard]] int tile_width(int section) const {
        const auto count = static_cast<int>(sections_.size());
        return options_.width * (section + 1) / count - options_.width * section / count;
    }

    [[nodiscard]] static std::string seconds(double time) {
        char text[40];
        std::snprintf(text, sizeof text, "%.3f", time);
        return text;
    }

    const RunFolder& run_;
    const RenderRunOptions& options_;
    std::vector<Body<Dim>> bodies_;
    std::vector<Section> sections_;
    Survey survey_;
    Camera tile_camera_;
    Camera sheet_camera_;
    Renderer renderer_;
};

// Everything there is to do, in one count for the progress: a look at each frame, then pictures.
class Count {
public:
    Count(const OnProgress& on_progress, std::size_t total)
        : on_progress_(on_progress), total_(static_cast<std::int64_t>(total)) {}

    [[nodiscard]] bool add_one() { return on_progress_(++done_, total_) || done_ == total_; }

private:
    const OnProgress& on_progress_;
    std::int64_t done_ = 0;
    std::int64_t total_;
};

template <int Dim>
bool render_frames(const Studio<Dim>& studio,
                   const RenderTargets& targets,
                   const RenderRunOptions& options,
                   Count& count,
                   RenderRunReport& report) {
    std::unique_ptr<Movie> movie;
    if (!targets.movie.empty()) {
        movie = std::make_unique<Movie>(targets.movie, options.width, options.height,
                                        options.frames_per_second);
    }
    for (const int frame : options.frames) {
        const Image image = studio.picture(frame);
        ++report.pictures;
        if (movie) {
            movie->add(image);
        }
        if (!targets.picture.empty()) {
            write_png(targets.picture, image);
            report.files.push_back(targets.picture.string());
        }
        if (!targets.folder.empty()) {
            write_png(targets.folder / picture_name(frame), image);
        }
        if (!count.add_one()) {
            return false;
        }
    }
    if (movie) {
        movie->finish();
        report.files.push_back(targets.movie.string());
    }
    if (!targets.folder.empty()) {
        report.files.push_back(targets.folder.string());
    }
    return true;
}

template <int Dim>
bool render_sheet(const Studio<Dim>& studio,
                  const RenderTargets& targets,
                  const RenderRunOptions& options,
                  Count& count,
                  RenderRunReport& report) {
    const std::vector<int> frames = spread(options.frames, options.sheet_frames);
    std::vector<Image> tiles;
    for (std::size_t section = 0; section < studio.section_count(); ++section) {
        for (const int frame : frames) {
            tiles.push_back(studio.sheet_tile(frame, section));
            ++report.pictures;
            if (!count.add_one()) {
                return false;
            }
        }
    }
    const auto count_of_frames = static_cast<int>(frames.size());
    const int columns = studio.section_count() > 1
                            ? count_of_frames
                            : static_cast<int>(std::ceil(std::sqrt(count_of_frames)));
    write_png(targets.sheet, contact_sheet(tiles, columns, kSheetGap, kSheetPaper));
    report.files.push_back(targets.sheet.string());
    return true;
}

template <int Dim>
RenderRunReport render_run_in(const RunFolder& run,
                              const RenderTargets& targets,
                              const RenderRunOptions& options,
                              const OnProgress& on_progress) {
    Studio<Dim> studio(run, options);
    if (!targets.folder.empty()) {
        make_folder(targets.folder);
    }
    const bool has_frames =
        !targets.movie.empty() || !targets.picture.empty() || !targets.folder.empty();
    const bool has_sheet = !targets.sheet.empty();
    const std::size_t tiles =
        spread(options.frames, options.sheet_frames).size() * studio.section_count();
    Count count(on_progress,
                options.frames.size() * (has_frames ? 2 : 1) + (has_sheet ? tiles : 0));
    RenderRunReport report;
    if (!studio.prepare([&] { return count.add_one(); })) {
        return report;
    }
    report.is_empty = studio.seen().box.isEmpty();
    report.range = studio.seen().range;
    report.is_complete = (!has_sheet || render_sheet(studio, targets, options, count, report))
                         && (!has_frames || render_frames(studio, targets, options, count, report));
    return report;
}

}  // namespace

RenderRunReport render_run(const RunFolder& run,
                           const RenderTargets& targets,
                           const RenderRunOptions& options,
                           const OnProgress& on_progress) {
    check(targets, options);
    return run.dimension == 4 ? render_run_in<4>(run, targets, options, on_progress)
                              : render_run_in<3>(run, targets, options, on_progress);
}

}  // namespace pent::viewer
