#pragma once

#include <pent/viewer/coloring.h>
#include <pent/viewer/image.h>
#include <pent/viewer/text.h>

#include <string>
#include <vector>

namespace pent::viewer {

/// Height of the letters that suits a picture, in pixels.
[[nodiscard]] int caption_pixels(int picture_height);

/// A caption as it is written: what is too long for one line has several.
struct Caption {
    std::vector<std::string> lines;  ///< None: there is no caption.
    int end = 0;                     ///< Of the longest, in pixels from the left edge.
};

/// Lays a caption out in a picture. Where it does not fit, what has four spaces between goes into
/// lines of its own, which are broken behind commas.
[[nodiscard]] Caption lay_out_caption(const Font& font, const std::string& text, int width);

/// Writes it into the lower left corner.
void draw_caption(Image& image, const Font& font, const Caption& caption);

/// How much of a picture, from its lower edge, caption and color bar take up, in pixels.
///
/// @param width  Of the picture.
[[nodiscard]] int legend_height(const Font& font, int width, const Caption& caption, bool has_bar);

/// Draws a bar of the colors with its ends' values and a title into the lower right corner, or
/// above the caption where there is no room beside it. A range of one value is one color.
///
/// @param by         Not ColorBy::Body.
/// @param dimension  Of the bodies.
void draw_color_bar(Image& image,
                    const Font& font,
                    const ColorBy& by,
                    int dimension,
                    const ColorRange& range,
                    const Caption& caption);

}  // namespace pent::viewer
