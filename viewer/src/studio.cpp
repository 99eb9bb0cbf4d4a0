#include "studio.h"

#include <pent/formatted.h>
#include <pent/viewer/attributes.h>
#include <pent/viewer/legend.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace pent::viewer {

namespace {

constexpr double kCrease = 1.0;  // radians: edges of boxes stay sharp, coarse organic shapes smooth
constexpr float kOnionOpacity = 0.22F;
constexpr float kOutlineOpacity = 0.07F;

std::string time_label(double time) {
    return formatted("t = %.3f s", time);
}

RenderObject to_object(Shown shown, ColorBy color, const ColorRange& range) {
    RenderObject object;
    object.colors = surface_colors(shown.values, color, range, shown.body);
    if (shown.tint && color == ColorBy::Body) {
        object.colors.colwise() = *shown.tint;
    }
    object.positions = std::move(shown.surface.positions);
    object.triangles = std::move(shown.surface.triangles);
    object.normals = std::move(shown.normals);
    object.opacity = shown.opacity;
    return object;
}

double aspect(int width, int height) {
    return static_cast<double>(width) / height;
}

}  // namespace

template <int Dim>
Studio<Dim>::Studio(const RunFolder& run, const RenderRunOptions& options)
    : run_(run),
      options_(options),
      bodies_(load_bodies<Dim>(run)),
      start_(load_moment<Dim>(run, bodies_, run.frames.front(), options.color)),
      sections_(make_sections<Dim>(options.sections, start_.frames)),
      tiles_(make_tiles()),
      tile_fit_(aspect(tile_width(0), options.height), options.view),
      sheet_fit_(aspect(options.width, options.height), options.view) {}

template <int Dim>
std::vector<typename Studio<Dim>::Tile> Studio<Dim>::make_tiles() const {
    std::vector<Tile> tiles;
    if (!options_.is_onion || sections_.size() < 2) {
        for (std::size_t section = 0; section < sections_.size(); ++section) {
            tiles.push_back({{section}, section, sections_[section].label});
        }
        return tiles;
    }
    Tile all;
    all.sections.resize(sections_.size());
    std::iota(all.sections.begin(), all.sections.end(), std::size_t{0});
    all.solid = sections_.size() / 2;
    all.label = sections_[all.solid].label + ", ghosts "
                + short_number(sections_.front().plane.offset) + " to "
                + short_number(sections_.back().plane.offset);
    tiles.push_back(std::move(all));
    return tiles;
}

template <int Dim>
void Studio<Dim>::look_at(int frame) {
    const Moment<Dim> moment = load_moment<Dim>(run_, bodies_, frame, options_.color);
    for (const Tile& tile : tiles_) {
        for (const Shown& shown : shown_in(tile, moment, false)) {
            survey_.add(shown.surface, shown.values, options_.color);
            tile_fit_.add(shown.surface.positions);
            sheet_fit_.add(shown.surface.positions);
        }
    }
}

template <int Dim>
void Studio<Dim>::settle() {
    tile_camera_ = tile_fit_.camera();
    sheet_camera_ = sheet_fit_.camera();
    range_ = options_.range ? *options_.range : survey_.range.value_or(ColorRange());
}

template <int Dim>
double Studio<Dim>::true_rate() const {
    constexpr double kUsual = 30;
    const std::vector<int>& frames = options_.frames;
    const double first = load_frame<Dim>(run_, bodies_.front(), frames.front()).time;
    const double last = load_frame<Dim>(run_, bodies_.front(), frames.back()).time;
    const double rate = static_cast<double>(frames.size() - 1) / (last - first);
    return last > first && !options_.is_sweep ? std::clamp(rate, 0.1, 1000.0) : kUsual;
}

template <int Dim>
Image Studio<Dim>::picture(int frame) const {
    const Moment<Dim> moment = load_moment<Dim>(run_, bodies_, frame, options_.color);
    Image image(options_.width, options_.height);
    int left = 0;
    for (std::size_t t = 0; t < tiles_.size(); ++t) {
        const int width = tile_width(t);
        const bool has_bar = t + 1 == tiles_.size();
        paste(image, paint(moment, tiles_[t], tile_camera_, width, options_.height, has_bar), left,
              0);
        left += width;
    }
    return image;
}

template <int Dim>
Image Studio<Dim>::tile_picture(int frame, std::size_t tile) const {
    const Moment<Dim> moment = load_moment<Dim>(run_, bodies_, frame, options_.color);
    return paint(moment, tiles_[tile], sheet_camera_, options_.width, options_.height, true);
}

template <int Dim>
Image Studio<Dim>::small_tile(int frame, std::size_t tile, bool has_bar) const {
    const Moment<Dim> moment = load_moment<Dim>(run_, bodies_, frame, options_.color);
    return paint(moment, tiles_[tile], sheet_camera_, options_.width * 3 / 8,
                 options_.height * 3 / 8, has_bar);
}

template <int Dim>
std::vector<Shown> Studio<Dim>::shown_in(const Tile& tile,
                                         const Moment<Dim>& moment,
                                         bool with_normals) const {
    std::vector<Shown> all;
    for (std::size_t body = 0; body < bodies_.size(); ++body) {
        for (const std::size_t section : tile.sections) {
            all.push_back(slice_of(body, tile, section, moment, with_normals));
        }
        if (options_.projection) {
            all.push_back(outline_of(body, tile, moment, with_normals));
        }
    }
    return all;
}

template <int Dim>
Shown Studio<Dim>::slice_of(std::size_t body,
                            const Tile& tile,
                            std::size_t section,
                            const Moment<Dim>& moment,
                            bool with_normals) const {
    const Positions<Dim>& positions = moment.frames[body].positions;
    Shown shown;
    shown.surface = take_section<Dim>(bodies_[body], positions, sections_[section]);
    shown.values = interpolate(shown.surface, moment.values[body]);
    shown.body = body;
    if (with_normals) {
        const Eigen::Matrix<double, 3, Dim> axes =
            sections_[section].plane.frame.template topLeftCorner<3, Dim>();
        shown.normals =
            corner_normals<Dim>(shown.surface, bodies_[body].boundary, positions, axes, kCrease);
    }
    if (section != tile.solid) {
        shown.opacity = kOnionOpacity;
        const double place =
            static_cast<double>(section) / static_cast<double>(sections_.size() - 1);
        shown.tint = map_color(ColorMap::Diverging, place);
    }
    return shown;
}

template <int Dim>
Shown Studio<Dim>::outline_of(std::size_t body,
                              const Tile& tile,
                              const Moment<Dim>& moment,
                              bool with_normals) const {
    Shown shown;
    if constexpr (Dim == 4) {
        const Projection projection =
            make_projection(*options_.projection, sections_[tile.solid].plane, start_.frames);
        shown.surface = outline(bodies_[body].boundary, moment.frames[body].positions, projection);
        shown.values = interpolate(shown.surface, moment.values[body]);
        if (with_normals) {
            shown.normals = corner_normals(shown.surface, kCrease);
        }
    }
    shown.body = body;
    shown.opacity = kOutlineOpacity;
    return shown;
}

template <int Dim>
Image Studio<Dim>::paint(const Moment<Dim>& moment,
                         const Tile& tile,
                         const Camera& camera,
                         int width,
                         int height,
                         bool has_bar) const {
    std::vector<RenderObject> objects;
    for (Shown& shown : shown_in(tile, moment, true)) {
        objects.push_back(to_object(std::move(shown), options_.color, range_));
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
        const std::string line = time_label(moment.frames.front().time)
                                 + (tile.label.empty() ? "" : "    " + tile.label);
        const Font font(caption_pixels(height));
        const int end = draw_caption(image, font, line);
        if (has_bar && options_.color != ColorBy::Body) {
            draw_color_bar(image, font, color_map_of(options_.color), range_,
                           title_of(options_.color), end);
        }
    }
    return image;
}

// Tiles share the width of a picture, to the pixel.
template <int Dim>
int Studio<Dim>::tile_width(std::size_t tile) const {
    const auto i = static_cast<int>(tile);
    const auto count = static_cast<int>(tiles_.size());
    return options_.width * (i + 1) / count - options_.width * i / count;
}

template class Studio<3>;
template class Studio<4>;

}  // namespace pent::viewer
