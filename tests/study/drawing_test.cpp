#include "drawing.h"

#include <gtest/gtest.h>

namespace pent::study {
namespace {

constexpr Rgb kRed{1, 0, 0};

int red_pixels(const viewer::Image& image) {
    int count = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const std::uint8_t* pixel = image.pixel(x, y);
            count += pixel[0] > 200 && pixel[1] < 60 && pixel[2] < 60 ? 1 : 0;
        }
    }
    return count;
}

TEST(Raster, CoversTheAreaOfADisc) {
    Drawing drawing{.width = 100, .height = 100};
    drawing.discs.push_back({.center = {50, 50}, .radius = 20, .color = kRed});
    // pi 20^2 = 1257; the blended rim of 2 pi 20 = 126 pixels may count or not.
    EXPECT_NEAR(red_pixels(raster(drawing)), 1257, 126);
}

TEST(Raster, DrawsDashedLinesHalfAsLong) {
    Drawing drawing{.width = 220, .height = 20};
    drawing.lines.push_back({.from = {10, 10}, .to = {210, 10}, .color = kRed, .width = 4});
    const int solid = red_pixels(raster(drawing));
    EXPECT_NEAR(solid, 4 * 200, 2 * 4);
    drawing.lines[0].is_dashed = true;
    EXPECT_NEAR(red_pixels(raster(drawing)), solid / 2, 0.1 * solid);
}

TEST(Raster, KeepsWhatSticksOutOffThePicture) {
    Drawing drawing{.width = 30, .height = 30};
    drawing.lines.push_back({.from = {-50, -50}, .to = {80, 80}, .color = kRed, .width = 3});
    drawing.words.push_back({.at = {-5, 40}, .text = "wide words", .color = kRed});
    EXPECT_GT(red_pixels(raster(drawing)), 30);
}

TEST(Raster, PutsWordsWhereTheirAnchorSays) {
    const auto reds_left_of_middle = [](Anchor anchor) {
        Drawing drawing{.width = 200, .height = 40};
        drawing.words.push_back({.at = {100, 28}, .text = "HHHH", .anchor = anchor, .color = kRed});
        viewer::Image image = raster(drawing);
        const int all = red_pixels(image);
        image.width = 200;
        int left = 0;
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < 100; ++x) {
                left += image.pixel(x, y)[0] > 200 && image.pixel(x, y)[1] < 60 ? 1 : 0;
            }
        }
        EXPECT_GT(all, 0);
        return static_cast<double>(left) / all;
    };
    EXPECT_LT(reds_left_of_middle(Anchor::Left), 0.05);
    EXPECT_NEAR(reds_left_of_middle(Anchor::Middle), 0.5, 0.1);
    EXPECT_GT(reds_left_of_middle(Anchor::Right), 0.95);
}

}  // namespace
}  // namespace pent::study
