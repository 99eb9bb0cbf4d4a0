#pragma once

#include "runs.h"

#include <pent/viewer/image.h>
#include <pent/viewer/obstacle_slice.h>
#include <pent/viewer/render_run.h>

#include <gtest/gtest.h>

#include <fstream>
#include <png.h>
#include <sstream>

// What tests of slices and pictures of runs share.

namespace pent::viewer::test {

inline Image read_png(const std::filesystem::path& path) {
    png_image png = {};
    png.version = PNG_IMAGE_VERSION;
    EXPECT_NE(png_image_begin_read_from_file(&png, path.c_str()), 0) << png.message;
    png.format = PNG_FORMAT_RGB;
    Image image(static_cast<int>(png.width), static_cast<int>(png.height));
    EXPECT_NE(png_image_finish_read(&png, nullptr, image.rgb.data(), 0, nullptr), 0) << png.message;
    return image;
}

inline bool go_on(std::string_view /*what*/, std::int64_t /*done*/, std::int64_t /*total*/) {
    return true;
}

inline std::string text_in(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

inline std::size_t count_files(const std::filesystem::path& folder) {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

inline RenderRunOptions small_pictures(const RunFolder& run) {
    RenderRunOptions options;
    options.frames = run.frames;
    options.width = 96;
    options.height = 64;
    return options;
}

// Ground under the run's body, and a ball that reaches past both hyperplanes.
inline std::vector<ObstacleShape<4>> floor_and_ball(double scale = 1) {
    return {HalfSpace<4>{Eigen::Vector4d::UnitY(), -0.1 * scale},
            Ball<4>{scale * Eigen::Vector4d(2, 0.5, 0.5, 0.5), 0.4 * scale}};
}

}  // namespace pent::viewer::test
