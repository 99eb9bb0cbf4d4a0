#include "run_renderer.h"

#include "obstacle_view.h"

#include <pent/formatted.h>
#include <pent/viewer/attributes.h>
#include <pent/viewer/legend.h>
#include <pent/viewer/obstacle_surface.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pent::viewer {

namespace {

constexpr float kOnionOpacity = 0.22F;
constexpr float kOutlineOpacity = 0.07F;
constexpr double kMaxLegend = 1.0 / 3;  // of the height of a picture

std::string caption_of(double time, int digits, const Tile& tile) {
    return formatted("t = %.*f s", digits, time) + (tile.label.empty() ? "" : "    " + tile.label);
}

// Behind the point, as many as tell apart so many times from the first to the last.
int digits_of(const std::array<double, 2>& times, std::size_t count) {
    constexpr double kFewest = 3;
    constexpr double kMost = 15;
    constexpr double kRounding = 1e-6;  // of times that are sums: a thousandth has 3 digits
    const double between =
        count > 1 ? (times[1] - times[0]) / static_cast<double>(count - 1) : times[0];
    const double needed = between > 0 ? std::ceil(-std::log10(between) - kRounding) : kFewest;
    return static_cast<int>(std::clamp(needed, kFewest, kMost));
}

double aspect(int width, int height) {
    return static_cast<double>(width) / height;
}

}  // namespace

template <int Dim>
RunRenderer<Dim>::RunRenderer(const RunFolder& run, const RenderRunOptions& options)
    : run_(run),
      options_(options),
      bodies_(load_bodies<Dim>(run)),
      start_(load_snapshot<Dim>(run, bodies_, run.frames.front(), options.color)),
      sections_(make_sections<Dim>(options.sections, start_.frames)),
      tiles_(make_tiles(sections_, options.sections, options.is_onion)),
      times_{load_frame<Dim>(run, bodies_.front(), options.frames.front()).time,
             load_frame<Dim>(run, bodies_.front(), options.frames.back()).time},
      time_digits_(digits_of(times_, options.frames.size())),
      framing_(make_fit(tile_size(0), has_color_bar()),
               options.is_sweep ? make_fit({options.width, options.height}, has_color_bar())
                                : make_fit(small_size(), false)) {}

template <int Dim>
bool RunRenderer<Dim>::has_color_bar() const {
    return options_.has_caption && options_.color != ColorBy::Body;
}

// Tiles share the width of a picture, to the pixel.
template <int Dim>
typename RunRenderer<Dim>::Size RunRenderer<Dim>::tile_size(std::size_t tile) const {
    const auto i = static_cast<int>(tile);
    const auto count = static_cast<int>(tiles_.size());
    return {options_.width * (i + 1) / count - options_.width * i / count, options_.height};
}

template <int Dim>
typename RunRenderer<Dim>::Size RunRenderer<Dim>::small_size() const {
    return {options_.width * 3 / 8, options_.height * 3 / 8};
}

template <int Dim>
std::string RunRenderer<Dim>::longest_caption() const {
    constexpr double kLongTime = 10;  // s: two digits before the point
    std::string longest;
    for (const Tile& tile : tiles_) {
        const std::string line = caption_of(kLongTime, time_digits_, tile);
        longest = line.size() > longest.size() ? line : longest;
    }
    return longest;
}

// Letters as large as suit the height and, down to what can be read, the width.
template <int Dim>
int RunRenderer<Dim>::caption_size(Size size) const {
    constexpr int kReadable = 9;
    const std::string line = longest_caption();
    int pixels = caption_pixels(size.height);
    while (pixels > kReadable && lay_out_caption(Font(pixels), line, size.width).lines.size() > 1) {
        --pixels;
    }
    return pixels;
}

// Leaves room for the longest caption.
template <int Dim>
CameraFit RunRenderer<Dim>::make_fit(Size size, bool has_bar) const {
    double share = 0;
    if (options_.has_caption) {
        const Font font(caption_size(size));
        const Caption caption = lay_out_caption(font, longest_caption(), size.width);
        share = legend_height(font, size.width, caption, has_bar) / double(size.height);
        if (share > kMaxLegend) {
            share = std::min(kMaxLegend,
                             legend_height(font, size.width, caption, false) / double(size.height));
        }
    }
    return {aspect(size.width, size.height), options_.view, share};
}

template <int Dim>
void RunRenderer<Dim>::look_at(int frame) {
    const Snapshot<Dim> snapshot = load_snapshot<Dim>(run_, bodies_, frame, options_.color);
    for (const Tile& tile : tiles_) {
        for (const DrawItem& item : items_in(tile, snapshot, false)) {
            survey_.add(item.surface, snapshot.values[item.body], options_.color);
            framing_.add(item.surface.positions);
        }
        look_at_obstacles(tile, snapshot);
    }
}

template <int Dim>
void RunRenderer<Dim>::look_at_obstacles(const Tile& tile, const Snapshot<Dim>& snapshot) {
    for (const ObstacleShape<Dim>& obstacle : shown_obstacles(snapshot)) {
        for (const std::size_t section : tile.sections) {
            const ObstacleSlice slice = take_section<Dim>(obstacle, sections_[section]);
            const std::optional<double> radius = radius_of(slice);
            if (radius && (!slice.hollow || section == tile.solid)) {
                framing_.add_round(wall_surface(slice, kCoarseCircle).positions, *radius);
            }
        }
        if constexpr (Dim == 4) {
            if (options_.projection) {
                const TriangleMesh image =
                    obstacle_outline(obstacle, projection_of(tile), kCoarseCircle);
                framing_.add_round(image.positions, 0.5 * bounding_box(image).diagonal().norm());
            }
        }
    }
}

template <int Dim>
void RunRenderer<Dim>::settle() {
    framing_.settle();
    range_ = options_.range.value_or(survey_.range());
}

template <int Dim>
double RunRenderer<Dim>::true_rate() const {
    constexpr double kUsual = 30;
    const auto [first, last] = times_;
    const double rate = static_cast<double>(options_.frames.size() - 1) / (last - first);
    return last > first && !options_.is_sweep ? rate : kUsual;
}

template <int Dim>
Image RunRenderer<Dim>::picture(int frame) const {
    const Snapshot<Dim> snapshot = load_snapshot<Dim>(run_, bodies_, frame, options_.color);
    Image image(options_.width, options_.height);
    int left = 0;
    for (std::size_t t = 0; t < tiles_.size(); ++t) {
        const Size size = tile_size(t);
        const bool has_bar = t + 1 == tiles_.size();
        paste(image, paint(snapshot, tiles_[t], framing_.tile_camera(), size, has_bar), left, 0);
        left += size.width;
    }
    return image;
}

template <int Dim>
Image RunRenderer<Dim>::tile_picture(int frame, std::size_t tile) const {
    const Snapshot<Dim> snapshot = load_snapshot<Dim>(run_, bodies_, frame, options_.color);
    return paint(snapshot, tiles_[tile], framing_.sheet_camera(), {options_.width, options_.height},
                 true);
}

template <int Dim>
Image RunRenderer<Dim>::small_tile(int frame, std::size_t tile) const {
    const Snapshot<Dim> snapshot = load_snapshot<Dim>(run_, bodies_, frame, options_.color);
    return paint(snapshot, tiles_[tile], framing_.sheet_camera(), small_size(), false);
}

template <int Dim>
Image RunRenderer<Dim>::sheet_legend(int width, const Color& paper) const {
    if (!has_color_bar()) {
        return {};
    }
    const Font font(caption_size(small_size()));
    Image strip(width, legend_height(font, width, {}, true));
    fill(strip, paper);
    draw_color_bar(strip, font, options_.color, Dim, range_, {});
    return strip;
}

template <int Dim>
std::vector<DrawItem> RunRenderer<Dim>::items_in(const Tile& tile,
                                                 const Snapshot<Dim>& snapshot,
                                                 bool with_normals) const {
    std::vector<DrawItem> all;
    for (std::size_t body = 0; body < bodies_.size(); ++body) {
        for (const std::size_t section : tile.sections) {
            all.push_back(slice_of(body, tile, section, snapshot, with_normals));
        }
        if (options_.projection) {
            all.push_back(outline_of(body, tile, snapshot, with_normals));
        }
    }
    return all;
}

template <int Dim>
DrawItem RunRenderer<Dim>::slice_of(std::size_t body,
                                    const Tile& tile,
                                    std::size_t section,
                                    const Snapshot<Dim>& snapshot,
                                    bool with_normals) const {
    const Positions<Dim>& positions = snapshot.frames[body].positions;
    DrawItem item;
    item.surface = take_section<Dim>(bodies_[body], positions, sections_[section]);
    item.body = body;
    if (with_normals) {
        const Eigen::Matrix<double, 3, Dim> axes =
            sections_[section].plane.frame.template topLeftCorner<3, Dim>();
        item.normals =
            corner_normals<Dim>(item.surface, bodies_[body].boundary, positions, axes, kCrease);
    }
    item.tint = ghost_tint(tile, section);
    item.opacity = item.tint ? kOnionOpacity : 1;
    return item;
}

template <int Dim>
DrawItem RunRenderer<Dim>::outline_of(std::size_t body,
                                      const Tile& tile,
                                      const Snapshot<Dim>& snapshot,
                                      bool with_normals) const {
    DrawItem item;
    if constexpr (Dim == 4) {
        item.surface =
            outline(bodies_[body].boundary, snapshot.frames[body].positions, projection_of(tile));
        if (with_normals) {
            item.normals = corner_normals(item.surface, kCrease);
        }
    }
    item.body = body;
    item.opacity = kOutlineOpacity;
    return item;
}

template <int Dim>
Projection RunRenderer<Dim>::projection_of(const Tile& tile) const {
    if constexpr (Dim == 4) {
        return make_projection(*options_.projection, sections_[tile.solid].plane, start_.frames);
    }
    return {};
}

template <int Dim>
std::span<const ObstacleShape<Dim>> RunRenderer<Dim>::shown_obstacles(
    const Snapshot<Dim>& snapshot) const {
    return std::span(snapshot.obstacles)
        .first(options_.has_obstacles ? snapshot.obstacles.size() : 0);
}

template <int Dim>
void RunRenderer<Dim>::add_items(const Tile& tile,
                                 const Snapshot<Dim>& snapshot,
                                 std::vector<RenderObject>& objects) const {
    for (DrawItem& item : items_in(tile, snapshot, true)) {
        const Eigen::VectorXd values = interpolate(item.surface, snapshot.values[item.body]);
        RenderObject object;
        object.colors = surface_colors(values, options_.color, range_, item.body);
        if (item.tint && options_.color == ColorBy::Body) {
            object.colors.colwise() = *item.tint;
        }
        object.positions = std::move(item.surface.positions);
        object.triangles = std::move(item.surface.triangles);
        object.normals = std::move(item.normals);
        object.opacity = item.opacity;
        objects.push_back(std::move(object));
    }
}

// Balls and boxes are ghosts as bodies are; ground is not: it would lie over all the rest.
template <int Dim>
void RunRenderer<Dim>::add_obstacle_ghosts(const Tile& tile,
                                           const Snapshot<Dim>& snapshot,
                                           const Camera& camera,
                                           int height,
                                           std::vector<RenderObject>& objects) const {
    for (const ObstacleShape<Dim>& obstacle : shown_obstacles(snapshot)) {
        for (const std::size_t section : tile.sections) {
            const ObstacleSlice slice = take_section<Dim>(obstacle, sections_[section]);
            const std::optional<Color> tint = ghost_tint(tile, section);
            if (tint && (slice.ball || slice.block)) {
                const int circle = slice.ball ? round_circle(*slice.ball, camera, height) : 0;
                objects.push_back(wall_object(slice, *tint, kOnionOpacity, circle));
            }
        }
        if constexpr (Dim == 4) {
            if (options_.projection) {
                objects.push_back(
                    outline_object(obstacle, projection_of(tile), kOutlineOpacity, camera, height));
            }
        }
    }
}

template <int Dim>
Image RunRenderer<Dim>::paint(const Snapshot<Dim>& snapshot,
                              const Tile& tile,
                              const Camera& camera,
                              Size size,
                              bool has_bar) const {
    std::vector<RenderObject> objects;
    add_items(tile, snapshot, objects);
    add_obstacle_ghosts(tile, snapshot, camera, size.height, objects);
    RenderOptions render;
    render.width = size.width;
    render.height = size.height;
    render.ground_color = obstacle_color();
    std::string line = caption_of(snapshot.frames.front().time, time_digits_, tile);
    const std::vector<ObstacleSlice> obstacles =
        take_sections<Dim>(shown_obstacles(snapshot), sections_[tile.solid]);
    for (const ObstacleSlice& slice : obstacles) {
        if (slice.block || (slice.ball && slice.ball->radius <= framing_.reach())) {
            const int circle = slice.ball ? round_circle(*slice.ball, camera, size.height) : 0;
            objects.push_back(wall_object(slice, obstacle_color(), 1, circle));
        } else if (!slice.is_empty) {
            render.grounds.push_back(slice);
        }
    }
    if (std::any_of(obstacles.begin(), obstacles.end(),
                    [](const ObstacleSlice& slice) { return slice.is_everything(); })) {
        line += ", all solid";
    }
    if (!framing_.box().isEmpty()) {
        // At the least a millionth of how far away it is: what is smaller is a point in any case.
        render.scene_size = std::max(framing_.box().diagonal().norm(),
                                     1e-6 * (camera.position - camera.target).norm());
        render.scene_center = framing_.box().center();
        if (options_.has_floor && !has_ground_below(obstacles)) {
            render.floor = framing_.box().min().y() - 2e-3 * render.scene_size;
        }
    }
    Image image = renderer_.render(objects, camera, render);
    write_legend(image, line, has_bar);
    return image;
}

template <int Dim>
void RunRenderer<Dim>::write_legend(Image& image, const std::string& line, bool has_bar) const {
    if (!options_.has_caption) {
        return;
    }
    const Font font(caption_size({image.width, image.height}));
    const Caption caption = lay_out_caption(font, line, image.width);
    draw_caption(image, font, caption);
    const bool has_room =
        legend_height(font, image.width, caption, true) <= kMaxLegend * image.height;
    if (has_bar && has_color_bar() && has_room) {
        draw_color_bar(image, font, options_.color, Dim, range_, caption);
    }
}

template class RunRenderer<3>;
template class RunRenderer<4>;

}  // namespace pent::viewer
