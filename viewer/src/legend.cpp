#include "pent/viewer/legend.h"

#include <pent/viewer/section.h>

#include <algorithm>
#include <string>

namespace pent::viewer {

namespace {

const Color kInk(0.035F, 0.04F, 0.05F);

}  // namespace

int caption_pixels(int picture_height) {
    return std::clamp(picture_height / 30, 13, 48);
}

int draw_caption(Image& image, const Font& font, std::string_view line) {
    const int margin = font.pixels();
    font.draw(image, margin, image.height - margin, line, kInk);
    return margin + font.width(line);
}

void draw_color_bar(Image& image,
                    const Font& font,
                    ColorMap map,
                    const ColorRange& range,
                    std::string_view title,
                    int caption_end) {
    const int em = font.pixels();
    const int wide = std::min(10 * em, image.width - 2 * em);
    const int left = image.width - wide - em;
    const bool is_beside = left >= caption_end + em;
    const int bottom = image.height - (is_beside ? em : 5 * em / 2);
    const int top = bottom - 2 * em;  // of the bar, which is 2/3 em high; numbers stand below it
    for (int x = 0; x < wide; ++x) {
        const Color color = map_color(map, (x + 0.5) / wide);
        for (int y = top; y < top + 2 * em / 3; ++y) {
            blend(image, left + x, y, color, 1);
        }
    }
    const std::string high = short_number(range.high);
    font.draw(image, left, bottom, short_number(range.low), kInk);
    font.draw(image, left + wide - font.width(high), bottom, high, kInk);
    const int center = left + (wide - font.width(title)) / 2;
    font.draw(image, center, top - em / 3, title, kInk);
}

}  // namespace pent::viewer
