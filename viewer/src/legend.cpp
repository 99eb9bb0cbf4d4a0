#include "pent/viewer/legend.h"

#include <pent/viewer/section.h>

#include <algorithm>
#include <string>

namespace pent::viewer {

namespace {

const Color kInk(0.035F, 0.04F, 0.05F);

// From the lower edge up: a margin or the caption, the numbers, the bar over them, and the title.
struct BarLayout {
    int left;
    int width;
    int bottom;  // base line of the numbers, above the lower edge
    int bar;     // lower edge of the bar
    int top;     // upper edge of the bar
    int title;   // base line
};

BarLayout lay_out(const Font& font, int picture_width, int caption_end) {
    const int em = font.pixels();
    const int width = std::min(10 * em, picture_width - 2 * em);
    const int left = picture_width - width - em;
    const int bottom = left >= caption_end + em ? em : 5 * em / 2;
    const int bar = bottom + 2 * em - 2 * em / 3;
    const int top = bottom + 2 * em;
    return {left, width, bottom, bar, top, top + em / 3};
}

}  // namespace

int caption_pixels(int picture_height) {
    return std::clamp(picture_height / 30, 13, 48);
}

int caption_end(const Font& font, std::string_view line) {
    return font.pixels() + font.width(line);
}

int draw_caption(Image& image, const Font& font, std::string_view line) {
    const int margin = font.pixels();
    font.draw(image, margin, image.height - margin, line, kInk);
    return caption_end(font, line);
}

int legend_height(const Font& font, int width, int caption_end, bool has_bar) {
    if (has_bar) {
        return lay_out(font, width, caption_end).title + font.pixels();
    }
    return caption_end > 0 ? 2 * font.pixels() : 0;
}

void draw_color_bar(
    Image& image, const Font& font, ColorBy by, const ColorRange& range, int caption_end) {
    const BarLayout at = lay_out(font, image.width, caption_end);
    for (int x = 0; x < at.width; ++x) {
        const double value = range.low + (range.high - range.low) * (x + 0.5) / at.width;
        const Color color = map_color(color_map_of(by), range.place(value, by));
        for (int y = at.bar; y < at.top; ++y) {
            blend(image, at.left + x, image.height - 1 - y, color, 1);
        }
    }
    const auto write = [&](int share, int base, std::string_view line) {  // share: 0, 1 or 2 halves
        const int x = at.left + share * (at.width - font.width(line)) / 2;
        font.draw(image, x, image.height - base, line, kInk);
    };
    if (range.high > range.low) {
        write(0, at.bottom, short_number(range.low));
        write(2, at.bottom, short_number(range.high));
    } else {
        write(1, at.bottom, short_number(range.low));
    }
    write(1, at.title, title_of(by));
}

}  // namespace pent::viewer
