#pragma once

#include <pent/viewer/color.h>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace pent::viewer {

/// A picture: rows from the top, three bytes a pixel, red green blue in sRGB.
struct Image {
    Image() = default;
    Image(int wide, int high);

    [[nodiscard]] std::uint8_t* pixel(int x, int y) {
        return &rgb[3 * (width * std::size_t(y) + x)];
    }
    [[nodiscard]] const std::uint8_t* pixel(int x, int y) const {
        return &rgb[3 * (width * std::size_t(y) + x)];
    }

    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgb;  ///< 3 width height.
};

/// Lays a color over one pixel, covering the share `alpha` (0..1) of it; outside the image nothing.
void blend(Image& image, int x, int y, const Color& color, float alpha);

/// Gives every pixel one color.
void fill(Image& image, const Color& color);

/// Copies `part` into the image with its upper left corner at (x, y); what sticks out is cut off.
void paste(Image& image, const Image& part, int x, int y);

/// Pictures in rows of `columns`, on the given background, with `gap` pixels between and around.
/// All pictures have one size.
[[nodiscard]] Image contact_sheet(const std::vector<Image>& pictures,
                                  int columns,
                                  int gap,
                                  const Color& background);

/// Two pictures of one width, the second under the first.
[[nodiscard]] Image stacked(const Image& above, const Image& below);

/// Writes a PNG through an OutputFile. Throws an Error as that does.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace pent::viewer
