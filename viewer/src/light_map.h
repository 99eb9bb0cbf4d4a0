#pragma once

#include "lighting.h"
#include "pixels.h"
#include "sight.h"

#include <array>
#include <vector>

namespace pent::viewer {

/// How much light arrives at what each pixel of a picture sees: a few rays in a pattern that
/// differs in each of 8 x 8 pixels, then the mean of that over each such block, without crossing
/// edges, which makes 64 times the rays of it.
class LightMap {
public:
    /// Keeps views of all three.
    LightMap(const Sight& sight, const Lighting& lighting, const PixelGrid<Sample>& samples);

    [[nodiscard]] const Visibility& at(int x, int y) const { return light_.at(x, y); }

    /// The light at a sample inside a pixel: that of the neighboring pixel most like it.
    [[nodiscard]] Visibility borrowed(const Sample& sample, int x, int y) const;

private:
    [[nodiscard]] Visibility trace(const Sample& sample, int pattern) const;
    [[nodiscard]] Visibility filtered(const PixelGrid<Visibility>& from,
                                      int x,
                                      int y,
                                      int stride,
                                      const std::array<float, 5>& weights) const;

    const Sight& sight_;
    const Lighting& lighting_;
    const PixelGrid<Sample>& samples_;
    PixelGrid<Visibility> light_;
};

}  // namespace pent::viewer
