#pragma once

#include <pent/parallel.h>

#include <cstddef>
#include <vector>

namespace pent::viewer {

/// A value for each pixel of a picture.
template <typename Value>
class PixelGrid {
public:
    PixelGrid(int width, int height)
        : width_(width), height_(height), values_(static_cast<std::size_t>(width) * height) {}

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }

    [[nodiscard]] bool has(int x, int y) const {
        return x >= 0 && y >= 0 && x < width_ && y < height_;
    }

    /// The pixel must be there.
    [[nodiscard]] Value& at(int x, int y) {
        return values_[static_cast<std::size_t>(width_) * y + x];
    }
    [[nodiscard]] const Value& at(int x, int y) const {
        return values_[static_cast<std::size_t>(width_) * y + x];
    }

private:
    int width_;
    int height_;
    std::vector<Value> values_;
};

/// Calls action(x, y) for every pixel, in parallel and in no order; each must write only its own.
template <typename Action>
void for_each_pixel(int width, int height, const Action& action) {
    constexpr int kRows = 4;
    parallel_for(height, kRows, [&](int y) {
        for (int x = 0; x < width; ++x) {
            action(x, y);
        }
    });
}

}  // namespace pent::viewer
