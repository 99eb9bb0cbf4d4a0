#include "drawing.h"

#include <pent/formatted.h>
#include <pent/viewer/text.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

namespace pent::study {

namespace {

constexpr double kDash = 5;  // pixels on and off

std::string hex(const Rgb& color) {
    const auto channel = [](float value) { return static_cast<int>(std::lround(255 * value)); };
    return formatted("#%02x%02x%02x", channel(color[0]), channel(color[1]), channel(color[2]));
}

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '&') {
            result += "&amp;";
        } else if (c == '<') {
            result += "&lt;";
        } else {
            result += c;
        }
    }
    return result;
}

const char* name_of(Anchor anchor) {
    switch (anchor) {
        case Anchor::Left:
            return "start";
        case Anchor::Middle:
            return "middle";
        case Anchor::Right:
            return "end";
    }
    return "";  // GCOVR_EXCL_LINE: there are no other anchors
}

viewer::Color to_color(const Rgb& color) {
    return viewer::from_srgb(color[0], color[1], color[2]);
}

// Lays the color over every pixel of a box by how much of it `inside` (pixels of depth, negative
// outside) says is covered.
template <typename Inside>
void fill(viewer::Image& image, Point low, Point high, const Rgb& color, const Inside& inside) {
    const viewer::Color mixed = to_color(color);
    for (int y = static_cast<int>(low.y) - 1; y <= static_cast<int>(high.y) + 1; ++y) {
        for (int x = static_cast<int>(low.x) - 1; x <= static_cast<int>(high.x) + 1; ++x) {
            const double cover = std::clamp(inside(x + 0.5, y + 0.5) + 0.5, 0.0, 1.0);
            if (cover > 0) {
                viewer::blend(image, x, y, mixed, static_cast<float>(cover));
            }
        }
    }
}

void draw(viewer::Image& image, const Line& line) {
    const double dx = line.to.x - line.from.x;
    const double dy = line.to.y - line.from.y;
    const double length = std::max(std::hypot(dx, dy), 1e-9);
    const double margin = line.width;
    const Point low{std::min(line.from.x, line.to.x) - margin,
                    std::min(line.from.y, line.to.y) - margin};
    const Point high{std::max(line.from.x, line.to.x) + margin,
                     std::max(line.from.y, line.to.y) + margin};
    fill(image, low, high, line.color, [&](double x, double y) {
        const double along = ((x - line.from.x) * dx + (y - line.from.y) * dy) / length;
        const double across = std::abs((x - line.from.x) * dy - (y - line.from.y) * dx) / length;
        const bool is_gap = line.is_dashed && std::fmod(std::max(along, 0.0), 2 * kDash) > kDash;
        return is_gap ? -1 : std::min({0.5 * line.width - across, along, length - along});
    });
}

void draw(viewer::Image& image, const Disc& disc) {
    const Point low{disc.center.x - disc.radius, disc.center.y - disc.radius};
    const Point high{disc.center.x + disc.radius, disc.center.y + disc.radius};
    fill(image, low, high, disc.color, [&](double x, double y) {
        return disc.radius - std::hypot(x - disc.center.x, y - disc.center.y);
    });
}

}  // namespace

std::string svg(const Drawing& drawing) {
    std::ostringstream out;
    out << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << drawing.width << "\" height=\""
        << drawing.height << "\" viewBox=\"0 0 " << drawing.width << ' ' << drawing.height
        << "\" font-family=\"DejaVu Sans, sans-serif\">\n"
        << "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
    for (const Line& line : drawing.lines) {
        out << "<line x1=\"" << line.from.x << "\" y1=\"" << line.from.y << "\" x2=\"" << line.to.x
            << "\" y2=\"" << line.to.y << "\" stroke=\"" << hex(line.color) << "\" stroke-width=\""
            << line.width << '"';
        if (line.is_dashed) {
            out << " stroke-dasharray=\"" << kDash << '"';
        }
        out << "/>\n";
    }
    for (const Disc& disc : drawing.discs) {
        out << "<circle cx=\"" << disc.center.x << "\" cy=\"" << disc.center.y << "\" r=\""
            << disc.radius << "\" fill=\"" << hex(disc.color) << "\"/>\n";
    }
    for (const Words& words : drawing.words) {
        out << "<text x=\"" << words.at.x << "\" y=\"" << words.at.y << "\" font-size=\""
            << words.pixels << "\" text-anchor=\"" << name_of(words.anchor) << "\" fill=\""
            << hex(words.color) << "\">" << escaped(words.text) << "</text>\n";
    }
    out << "</svg>\n";
    return out.str();
}

viewer::Image raster(const Drawing& drawing) {
    viewer::Image image(drawing.width, drawing.height);
    std::ranges::fill(image.rgb, std::uint8_t{255});
    for (const Line& line : drawing.lines) {
        draw(image, line);
    }
    for (const Disc& disc : drawing.discs) {
        draw(image, disc);
    }
    std::map<int, viewer::Font> fonts;
    for (const Words& words : drawing.words) {
        const viewer::Font& font = fonts.try_emplace(words.pixels, words.pixels).first->second;
        const double width = font.width(words.text);
        const double left = words.anchor == Anchor::Left     ? 0
                            : words.anchor == Anchor::Middle ? width / 2
                                                             : width;
        font.draw(image, static_cast<int>(std::lround(words.at.x - left)),
                  static_cast<int>(std::lround(words.at.y)), words.text, to_color(words.color));
    }
    return image;
}

}  // namespace pent::study
