#include "light_map.h"

#include <algorithm>
#include <limits>

namespace pent::viewer {

namespace {

// Neighbors get patterns far apart: the bits of x and y, interleaved from the lowest on.
int pattern_at(int x, int y) {
    int number = 0;
    for (int bit = 0; bit < 3; ++bit) {
        number = 4 * number + 2 * ((x ^ y) >> bit & 1) + (y >> bit & 1);
    }
    return number;
}

}  // namespace

LightMap::LightMap(const Sight& sight, const Lighting& lighting, const PixelGrid<Sample>& samples)
    : sight_(sight),
      lighting_(lighting),
      samples_(samples),
      light_(samples.width(), samples.height()) {
    const int width = samples.width();
    const int height = samples.height();
    PixelGrid<Visibility> rough(width, height);
    for_each_pixel(width, height, [&](int x, int y) {
        const Sample& sample = samples_.at(x, y);
        if (sample.seen != Seen::Nothing) {
            rough.at(x, y) = trace(sample, pattern_at(x, y));
        }
    });
    PixelGrid<Visibility> smooth(width, height);
    for_each_pixel(width, height, [&](int x, int y) {
        smooth.at(x, y) = filtered(rough, x, y, 1, {1, 2, 2, 2, 1});
    });
    for_each_pixel(width, height, [&](int x, int y) {
        light_.at(x, y) = filtered(smooth, x, y, 4, {0, 1, 2, 1, 0});
    });
}

Visibility LightMap::trace(const Sample& sample, int pattern) const {
    return sight_.solids().is_empty()
               ? Visibility()
               : trace_visibility(sight_.solids(), lighting_, sample.lifted, sample.flat, pattern);
}

// A weighted mean over 5 x 5 pixels `stride` apart, of those like the middle one. With weights
// 1 2 2 2 1 at stride 1 each of 4 x 4 neighbors counts alike, and with 0 1 2 1 0 at stride 4
// after that each of 8 x 8.
Visibility LightMap::filtered(const PixelGrid<Visibility>& from,
                              int x,
                              int y,
                              int stride,
                              const std::array<float, 5>& weights) const {
    const Sample& here = samples_.at(x, y);
    if (here.seen == Seen::Nothing) {
        return {};
    }
    Visibility sum{0, 0};
    float total = 0;
    for (int row = 0; row < 5; ++row) {
        const int j = y + stride * (row - 2);
        for (int column = 0; column < 5; ++column) {
            const int i = x + stride * (column - 2);
            const float weight = weights[row] * weights[column];
            if (weight > 0 && samples_.has(i, j) && sight_.is_alike(here, samples_.at(i, j))) {
                sum.sky += weight * from.at(i, j).sky;
                sum.key += weight * from.at(i, j).key;
                total += weight;
            }
        }
    }
    return {sum.sky / total, sum.key / total};
}

Visibility LightMap::borrowed(const Sample& sample, int x, int y) const {
    const Visibility* best = nullptr;
    float best_distance = std::numeric_limits<float>::infinity();
    for (int j = std::max(0, y - 1); j <= std::min(samples_.height() - 1, y + 1); ++j) {
        for (int i = std::max(0, x - 1); i <= std::min(samples_.width() - 1, x + 1); ++i) {
            const Sample& there = samples_.at(i, j);
            const float distance = (there.point - sample.point).squaredNorm();
            if (distance < best_distance && sight_.is_alike(sample, there)) {
                best_distance = distance;
                best = &light_.at(i, j);
            }
        }
    }
    return best != nullptr ? *best : trace(sample, pattern_at(x, y));
}

}  // namespace pent::viewer
