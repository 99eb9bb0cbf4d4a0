#include "pent/viewer/legend.h"

#include <pent/viewer/section.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pent::viewer {

namespace {

const Color kInk(0.035F, 0.04F, 0.05F);

constexpr std::string_view kBetweenParts = "    ";
constexpr std::string_view kBetweenPieces = ", ";

std::vector<std::string> parts_of(const std::string& text, std::string_view separator) {
    std::vector<std::string> parts;
    std::size_t begin = 0;
    for (std::size_t end = 0; end != std::string::npos; begin = end + separator.size()) {
        end = text.find(separator, begin);
        parts.push_back(text.substr(begin, end - begin));
    }
    return parts;
}

// From the lower edge up: a margin or the caption, the numbers, the bar over them, and the title.
struct BarLayout {
    int left;
    int width;
    int bottom;  // base line of the numbers, above the lower edge
    int bar;     // lower edge of the bar
    int top;     // upper edge of the bar
    int title;   // base line
};

int line_height(const Font& font) {
    return 4 * font.pixels() / 3;
}

// How much more than one line.
int further_lines(const Font& font, const Caption& caption) {
    return std::max(static_cast<int>(caption.lines.size()) - 1, 0) * line_height(font);
}

BarLayout lay_out(const Font& font, int picture_width, const Caption& caption) {
    const int em = font.pixels();
    const int width = std::min(10 * em, picture_width - 2 * em);
    const int left = picture_width - width - em;
    const int bottom = left >= caption.end + em ? em : 5 * em / 2 + further_lines(font, caption);
    const int bar = bottom + 2 * em - 2 * em / 3;
    const int top = bottom + 2 * em;
    return {left, width, bottom, bar, top, top + em / 3};
}

}  // namespace

int caption_pixels(int picture_height) {
    return std::clamp(picture_height / 30, 13, 48);
}

Caption lay_out_caption(const Font& font, const std::string& text, int width) {
    const auto end_of = [&](const std::string& line) { return font.pixels() + font.width(line); };
    Caption caption;
    if (end_of(text) <= width) {
        return {{text}, end_of(text)};
    }
    for (const std::string& part : parts_of(text, kBetweenParts)) {
        std::string line;
        const std::vector<std::string> pieces = parts_of(part, kBetweenPieces);
        for (const std::string& piece : pieces) {
            const std::string more = piece + (&piece == &pieces.back() ? "" : ",");
            const std::string longer = line + (line.empty() ? "" : " ") + more;
            if (!line.empty() && end_of(longer) > width) {
                caption.lines.push_back(std::exchange(line, more));
            } else {
                line = longer;
            }
        }
        caption.lines.push_back(line);
    }
    for (const std::string& line : caption.lines) {
        caption.end = std::max(caption.end, end_of(line));
    }
    return caption;
}

void draw_caption(Image& image, const Font& font, const Caption& caption) {
    const int margin = font.pixels();
    int base = image.height - margin - further_lines(font, caption);
    for (const std::string& line : caption.lines) {
        font.draw(image, margin, base, line, kInk);
        base += line_height(font);
    }
}

int legend_height(const Font& font, int width, const Caption& caption, bool has_bar) {
    const int without_bar =
        caption.lines.empty() ? 0 : 2 * font.pixels() + further_lines(font, caption);
    return has_bar ? std::max(lay_out(font, width, caption).title + font.pixels(), without_bar)
                   : without_bar;
}

void draw_color_bar(Image& image,
                    const Font& font,
                    const ColorBy& by,
                    int dimension,
                    const ColorRange& range,
                    const Caption& caption) {
    const BarLayout at = lay_out(font, image.width, caption);
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
    write(1, at.title, title_of(by, dimension));
}

}  // namespace pent::viewer
