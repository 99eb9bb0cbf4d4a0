#pragma once

#include <pent/viewer/image.h>

#include <array>
#include <string>
#include <vector>

namespace pent::study {

/// A flat drawing of lines, discs and words, as SVG or as pixels. Units are pixels; y points down.

using Rgb = std::array<float, 3>;  ///< sRGB, 0..1.

struct Point {
    double x = 0;
    double y = 0;
};

struct Line {
    Point from = {};
    Point to = {};
    Rgb color{};
    double width = 1;
    bool is_dashed = false;
};

struct Disc {
    Point center = {};
    double radius = 3;
    Rgb color{};
};

enum class Anchor { Left, Middle, Right };

struct Words {
    Point at = {};  ///< The end of the baseline that `anchor` names.
    std::string text = {};
    Anchor anchor = Anchor::Left;
    int pixels = 13;  ///< Height of an em.
    Rgb color{};
};

/// Drawn in the order lines, discs, words, on white.
struct Drawing {
    int width = 0;
    int height = 0;
    std::vector<Line> lines = {};
    std::vector<Disc> discs = {};
    std::vector<Words> words = {};
};

[[nodiscard]] std::string svg(const Drawing& drawing);

[[nodiscard]] viewer::Image raster(const Drawing& drawing);

}  // namespace pent::study
