#pragma once

#include <pent/viewer/color.h>
#include <pent/viewer/coloring.h>
#include <pent/viewer/image.h>
#include <pent/viewer/text.h>

#include <string_view>

namespace pent::viewer {

/// Height of the letters that suits a picture, in pixels.
[[nodiscard]] int caption_pixels(int picture_height);

/// Writes a line into the lower left corner; returns where it ends, in pixels from the left.
int draw_caption(Image& image, const Font& font, std::string_view line);

/// Draws a bar of the colors with its ends' values and a title into the lower right corner, or
/// above the caption where there is no room beside it.
///
/// @param caption_end  What draw_caption() returned; 0 without a caption.
void draw_color_bar(Image& image,
                    const Font& font,
                    ColorMap map,
                    const ColorRange& range,
                    std::string_view title,
                    int caption_end);

}  // namespace pent::viewer
