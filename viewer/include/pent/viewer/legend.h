#pragma once

#include <pent/viewer/coloring.h>
#include <pent/viewer/image.h>
#include <pent/viewer/text.h>

#include <string_view>

namespace pent::viewer {

/// Height of the letters that suits a picture, in pixels.
[[nodiscard]] int caption_pixels(int picture_height);

/// Where a caption ends, in pixels from the left.
[[nodiscard]] int caption_end(const Font& font, std::string_view line);

/// Writes a line into the lower left corner; returns where it ends.
int draw_caption(Image& image, const Font& font, std::string_view line);

/// How much of a picture, from its lower edge, caption and color bar take up, in pixels.
///
/// @param width        Of the picture.
/// @param caption_end  0 without a caption.
[[nodiscard]] int legend_height(const Font& font, int width, int caption_end, bool has_bar);

/// Draws a bar of the colors with its ends' values and a title into the lower right corner, or
/// above the caption where there is no room beside it. A range of one value is one color.
///
/// @param by           Not ColorBy::Body.
/// @param caption_end  What draw_caption() returned; 0 without a caption.
void draw_color_bar(
    Image& image, const Font& font, ColorBy by, const ColorRange& range, int caption_end);

}  // namespace pent::viewer
