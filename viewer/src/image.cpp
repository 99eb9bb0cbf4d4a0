#include "pent/viewer/image.h"

#include <pent/error.h>
#include <pent/output_file.h>

#include <algorithm>
#include <array>
#include <png.h>

namespace pent::viewer {

Image::Image(int wide, int high)
    : width(wide), height(high), rgb(3 * static_cast<std::size_t>(wide) * high) {}

void blend(Image& image, int x, int y, const Color& color, float alpha) {
    if (x < 0 || y < 0 || x >= image.width || y >= image.height) {
        return;
    }
    std::uint8_t* pixel = image.pixel(x, y);
    const Color below =
        from_srgb(float(pixel[0]) / 255.0F, float(pixel[1]) / 255.0F, float(pixel[2]) / 255.0F);
    const std::array<std::uint8_t, 3> mixed = to_srgb(below + alpha * (color - below));
    std::copy(mixed.begin(), mixed.end(), pixel);
}

void fill(Image& image, const Color& color) {
    const std::array<std::uint8_t, 3> bytes = to_srgb(color);
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        image.rgb[i] = bytes[i % 3];
    }
}

void paste(Image& image, const Image& part, int x, int y) {
    const int first = std::max(0, -x);
    const int last = std::min(part.width, image.width - x);
    for (int row = std::max(0, -y); row < std::min(part.height, image.height - y) && first < last;
         ++row) {
        std::copy_n(part.pixel(first, row), 3 * (last - first), image.pixel(x + first, y + row));
    }
}

Image contact_sheet(const std::vector<Image>& pictures,
                    int columns,
                    int gap,
                    const Color& background) {
    if (pictures.empty()) {
        return {};
    }
    const int wide = pictures.front().width;
    const int high = pictures.front().height;
    const int rows = (static_cast<int>(pictures.size()) + columns - 1) / columns;
    Image sheet(gap + columns * (wide + gap), gap + rows * (high + gap));
    fill(sheet, background);
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        const int column = static_cast<int>(i) % columns;
        const int row = static_cast<int>(i) / columns;
        paste(sheet, pictures[i], gap + column * (wide + gap), gap + row * (high + gap));
    }
    return sheet;
}

Image stacked(const Image& above, const Image& below) {
    Image both(above.width, above.height + below.height);
    paste(both, above, 0, 0);
    paste(both, below, 0, above.height);
    return both;
}

void write_png(const std::filesystem::path& path, const Image& image) {
    png_image png = {};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(image.width);
    png.height = static_cast<png_uint_32>(image.height);
    png.format = PNG_FORMAT_RGB;
    png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(png);
    std::vector<std::uint8_t> buffer(bytes);
    if (png_image_write_to_memory(&png, buffer.data(), &bytes, 0, image.rgb.data(), 0, nullptr)
        == 0) {
        throw Error(path.string() + ": png: " + png.message);
    }
    OutputFile file(path);
    file.write(buffer.data(), bytes);
    file.commit();
}

}  // namespace pent::viewer
