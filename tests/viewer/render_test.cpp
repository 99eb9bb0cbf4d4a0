#include "pent/viewer/render.h"

#include "meshes.h"

#include <pent/error.h>
#include <pent/viewer/attributes.h>
#include <pent/viewer/legend.h>
#include <pent/viewer/slice.h>
#include <pent/viewer/text.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <support/host_tasks.h>
#include <support/messages.h>
#include <support/temp_folder.h>

namespace pent::viewer {
namespace {

// A gray box of the given size about the origin, seen from the front.
RenderObject gray_box(double size) {
    SimplexMesh<3> mesh = pent::test::kuhn_box<3>({1, 1, 1}, {size, size, size});
    mesh.positions.array() -= size / 2;
    const Boundary<3> boundary = make_boundary(mesh, "box");
    const Surface surface = skin(boundary, mesh.positions);
    RenderObject object;
    object.positions = surface.positions;
    object.triangles = surface.triangles;
    object.normals =
        corner_normals<3>(surface, boundary, mesh.positions, Eigen::Matrix3d::Identity(), 1.0);
    object.colors.setConstant(3, surface.vertex_count(), 0.5F);
    return object;
}

RenderOptions small_picture() {
    RenderOptions options;
    options.width = 64;
    options.height = 48;
    options.scene_size = 2;
    return options;
}

Image render(const RenderObject& object, const RenderOptions& options = small_picture()) {
    return Renderer().render({&object, 1}, {.position = {1, 1, 5}}, options);
}

bool is_magenta(const std::uint8_t* pixel) {
    return pixel[0] > 2 * pixel[1] && pixel[2] > 2 * pixel[1];
}

int count_magenta(const Image& image) {
    int count = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
        count += is_magenta(&image.rgb[i]) ? 1 : 0;
    }
    return count;
}

int difference(const Image& image, int x, int y, const Image& other, int ox, int oy) {
    int sum = 0;
    for (int channel = 0; channel < 3; ++channel) {
        sum += std::abs(image.pixel(x, y)[channel] - other.pixel(ox, oy)[channel]);
    }
    return sum;
}

TEST(Render, ShowsABodyInTheMiddleAndBackgroundAround) {
    const Image image = render(gray_box(1));
    const Image empty = Renderer().render({}, {.position = {1, 1, 5}}, small_picture());
    EXPECT_GT(difference(image, 32, 24, empty, 32, 24), 30);
    EXPECT_EQ(difference(image, 0, 0, empty, 0, 0), 0);
    EXPECT_EQ(difference(image, 63, 47, empty, 63, 47), 0);
}

TEST(Render, ShowsTheInsideOfASurfaceInMagentaAndTheOutsideNot) {
    RenderObject object = gray_box(1);
    EXPECT_EQ(count_magenta(render(object)), 0);
    object.triangles.row(0).swap(object.triangles.row(1));
    EXPECT_GT(count_magenta(render(object)), 100);
}

TEST(Render, DarkensTheFloorUnderABody) {
    RenderOptions options = small_picture();
    options.floor = -0.5;
    const Image image = render(gray_box(1), options);
    const Image empty = Renderer().render({}, {.position = {1, 1, 5}}, options);
    int darker = 0;
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        darker += image.rgb[i] + 40 < empty.rgb[i] ? 1 : 0;
    }
    EXPECT_GT(darker, 30);
}

TEST(Render, IsTheSameForOneAndTwoThreads) {
    const RenderObject object = gray_box(1);
    const Image reference = render(object);
    for (const int threads : {1, 2}) {
        const Image image =
            Workers(pent::test::host_tasks(threads)).run([&] { return render(object); });
        EXPECT_EQ(image.rgb, reference.rgb);
    }
}

TEST(Render, LosesNothingFarFromTheOrigin) {
    RenderObject object = gray_box(1);
    const Image near = render(object);
    const Eigen::Vector3d far(1e7, -2e7, 3e7);
    object.positions.colwise() += far;
    RenderOptions options = small_picture();
    options.scene_center = far;
    const Image image = Renderer().render(
        {&object, 1}, {.position = far + Eigen::Vector3d(1, 1, 5), .target = far}, options);
    // At 3e7 doubles are 4e-9 apart: a few edge samples at most may fall on the other side.
    int different = 0;
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        different += std::abs(image.rgb[i] - near.rgb[i]) > 8 ? 1 : 0;
    }
    EXPECT_LE(different, 6);
}

TEST(Render, SeesThroughGhosts) {
    RenderObject ghost = gray_box(1.2);
    ghost.opacity = 0.1F;
    const RenderObject body = gray_box(0.5);
    const RenderObject both[] = {body, ghost};
    const Camera camera{.position = {1, 1, 5}};
    const Image alone = Renderer().render({&body, 1}, camera, small_picture());
    const Image behind = Renderer().render(both, camera, small_picture());
    const Image empty = Renderer().render({}, camera, small_picture());
    EXPECT_LT(difference(behind, 32, 24, alone, 32, 24), 60);
    EXPECT_GT(difference(behind, 32, 24, alone, 32, 24), 0);
    EXPECT_GT(difference(behind, 32, 24, empty, 32, 24), 60);
}

TEST(Legend, WritesInTheCorners) {
    Image image(320, 180);
    for (std::uint8_t& byte : image.rgb) {
        byte = 255;
    }
    const Font font(caption_pixels(180));
    const Caption caption = lay_out_caption(font, "t = 1", 320);
    draw_caption(image, font, caption);
    draw_color_bar(image, font, ColorBy::Speed, 4, {0, 2}, caption);
    const auto darkest = [&](int x0, int x1, int y0, int y1) {
        int least = 255;
        for (int y = y0; y < y1; ++y) {
            for (int x = x0; x < x1; ++x) {
                least = std::min<int>(least, image.pixel(x, y)[1]);
            }
        }
        return least;
    };
    EXPECT_LT(darkest(0, 100, 140, 180), 100);
    EXPECT_LT(darkest(220, 320, 120, 180), 150);
    EXPECT_EQ(darkest(0, 320, 0, 100), 255);
}

TEST(Legend, PutsTheBarAboveACaptionThatLeavesNoRoom) {
    Image caption_alone(200, 180);
    std::fill(caption_alone.rgb.begin(), caption_alone.rgb.end(), std::uint8_t{255});
    const Font font(caption_pixels(180));
    const Caption caption = lay_out_caption(font, "t = 1.333 s    w = 0.25", 200);
    EXPECT_EQ(caption.lines.size(), 1U);
    draw_caption(caption_alone, font, caption);
    Image both = caption_alone;
    draw_color_bar(both, font, ColorBy::Speed, 4, {0, 2}, caption);
    EXPECT_NE(both.rgb, caption_alone.rgb);
    for (int y = 180 - 2 * font.pixels(); y < 180; ++y) {  // the caption's own lines
        for (int x = 0; x < 200; ++x) {
            ASSERT_EQ(*both.pixel(x, y), *caption_alone.pixel(x, y)) << x << " " << y;
        }
    }
}

TEST(Legend, IsAsHighAsItSays) {
    const Font font(20);
    const auto top_of = [](const Image& image) {
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                if (*image.pixel(x, y) != 255) {
                    return image.height - y;
                }
            }
        }
        return 0;
    };
    // Above the caption and beside it, with a line and with several.
    for (const std::string text : {"t = 1.333 s", "t = 1.333 s    w = 0.25, xw 12.5, zw 33.33"}) {
        for (const int width : {250, 700}) {
            Image image(width, 300);
            fill(image, Color::Ones());
            const Caption caption = lay_out_caption(font, text, width);
            draw_caption(image, font, caption);
            EXPECT_LE(top_of(image), legend_height(font, width, caption, false));
            EXPECT_GT(top_of(image), legend_height(font, width, caption, false) - font.pixels());
            Image margin(width, font.pixels() / 2);  // the last line is no nearer to the edge
            fill(margin, Color::Ones());
            EXPECT_TRUE(std::equal(margin.rgb.rbegin(), margin.rgb.rend(), image.rgb.rbegin()));
            draw_color_bar(image, font, ColorBy::Speed, 4, {0, 2}, caption);
            EXPECT_LE(top_of(image), legend_height(font, width, caption, true));
            EXPECT_GT(top_of(image), legend_height(font, width, caption, true) - font.pixels());
        }
    }
    EXPECT_EQ(legend_height(font, 700, {}, false), 0);
}

// Nothing of a caption is cut off, whatever the width, as long as its pieces fit, and nothing is
// lost: what sheets have to tell their rows apart by is often at its end.
TEST(Caption, IsAllInThePictureAndAllThere) {
    const Font font(9);
    for (const std::string text :
         {"t = 0.000 s", "t = 0.000 s    w = 0.1235, xy 10, zw 33.33, xw 12.5",
          "t = 10.000 s    (0.1826, 0.3651, 0.5477, 0.7303) . p = 0.3, all solid"}) {
        std::size_t fewer = 100;
        for (int width = 100; width < 500; width += 10) {
            const Caption caption = lay_out_caption(font, text, width);
            EXPECT_LE(caption.end, width);
            EXPECT_LE(caption.lines.size(), fewer);
            fewer = caption.lines.size();
            std::string joined;
            int longest = 0;
            for (const std::string& line : caption.lines) {
                joined += line;
                longest = std::max(longest, font.pixels() + font.width(line));
            }
            EXPECT_EQ(caption.end, longest);
            std::string expected = text;
            std::erase(expected, ' ');
            std::erase(joined, ' ');
            EXPECT_EQ(joined, expected);
        }
        EXPECT_EQ(fewer, 1U);  // where there is room
    }
}

TEST(Legend, HasOneColorAndOneNumberForARangeOfOneValue) {
    const Font font(20);
    Image image(400, 100);
    fill(image, Color::Ones());
    draw_color_bar(image, font, ColorBy::Strain, 4, {0, 0}, {});
    const std::array<std::uint8_t, 3> lowest = to_srgb(map_color(ColorMap::Heat, 0));
    int colored = 0;
    for (int x = 0; x < image.width; ++x) {
        for (int y = 0; y < image.height; ++y) {
            const std::uint8_t* pixel = image.pixel(x, y);
            colored += std::equal(lowest.begin(), lowest.end(), pixel) ? 1 : 0;
        }
    }
    EXPECT_GE(colored, 10 * 20 * (2 * 20 / 3));  // the whole bar: 10 x 2/3 em
}

TEST(Render, ShowsGroundWhereItFacesTheEye) {
    RenderOptions options = small_picture();
    const auto picture_of = [&](const Plane& plane, const Eigen::Vector3d& eye) {
        options.grounds = {{.plane = plane}};
        return Renderer().render({}, {.position = eye}, options);
    };
    options.ground_color = Color(0.1F, 0.4F, 0.1F);
    const Plane floor{Eigen::Vector3d::UnitY(), -0.5};
    const auto is_green = [](const std::uint8_t* p) {
        return p[1] > p[0] + 20 && p[1] > p[2] + 20;
    };
    const Image above = picture_of(floor, {1, 1, 5});
    EXPECT_TRUE(is_green(above.pixel(32, 40)));
    EXPECT_FALSE(is_green(above.pixel(32, 2)));
    const Image below = picture_of(floor, {1, -3, 5});
    EXPECT_FALSE(is_green(below.pixel(32, 24)));
    EXPECT_FALSE(is_green(below.pixel(32, 40)));
}

TEST(Render, ShowsABodyInAHollowThroughItsRimAndNotThroughAPlane) {
    const RenderObject body = gray_box(0.5);
    RenderOptions options = small_picture();
    const Camera low{.position = {0, 2, 6}};
    const Plane ground{Eigen::Vector3d::UnitY(), 0.6};  // over the body
    const auto seen_behind = [&](const ObstacleSlice& slice) {
        options.grounds = {slice};
        const Image with = Renderer().render({&body, 1}, low, options);
        const Image without = Renderer().render({}, low, options);
        return difference(with, 32, 24, without, 32, 24);
    };
    EXPECT_EQ(seen_behind({.plane = ground}), 0);
    EXPECT_GT(seen_behind({.plane = ground, .hollow = Sphere{{0, 0.3, 0}, 0.7}}), 30);
}

TEST(Font, IsWiderForLongerLinesAndDrawsNothingOutside) {
    const Font font(20);
    EXPECT_EQ(font.width(""), 0);
    EXPECT_GT(font.width("mm"), font.width("m"));
    Image image(10, 10);
    font.draw(image, -100, 500, "outside", Color::Ones());
    font.draw(image, 5, 5, "over the edge", Color::Ones());
    EXPECT_EQ(image.rgb.size(), 300U);
}

TEST(ContactSheet, LaysPicturesOutInRows) {
    Image dot(2, 2);
    dot.rgb.assign(12, 200);
    const Image sheet = contact_sheet({dot, dot, dot}, 2, 1, Color::Zero());
    ASSERT_EQ(sheet.width, 7);
    ASSERT_EQ(sheet.height, 7);
    const auto red = [&](int x, int y) { return int{sheet.pixel(x, y)[0]}; };
    EXPECT_EQ(red(0, 0), 0);
    EXPECT_EQ(red(1, 1), 200);
    EXPECT_EQ(red(4, 1), 200);
    EXPECT_EQ(red(1, 4), 200);
    EXPECT_EQ(red(4, 4), 0);  // no fourth picture
}

TEST(ContactSheet, OfNothingIsEmpty) {
    EXPECT_EQ(contact_sheet({}, 2, 1, Color::Zero()).rgb.size(), 0U);
}

TEST(WritePng, RefusesAPictureWithoutPixels) {
    const pent::test::TempFolder folder;
    pent::test::expect_contains(
        pent::test::error_of([&] { write_png(folder / "a.png", Image(0, 0)); }), {"a.png", "png"});
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace pent::viewer
