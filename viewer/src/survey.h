#pragma once

#include <pent/viewer/coloring.h>
#include <pent/viewer/surface.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace pent::viewer {

/// What holds for all that is shown in all frames, so that a movie has one scene and one color bar.
class Survey {
public:
    /// @param values  Of the colored quantity at the vertices of the body, not of the surface.
    void add(const Surface& surface, const Eigen::VectorXd& values, const ColorBy& color) {
        if (surface.vertex_count() == 0) {
            return;
        }
        box_.extend(bounding_box(surface));
        const ColorRange here = suitable_range(interpolate(surface, values), color);
        range_ = range_ ? joined(*range_, here) : here;
        is_strain_ = color == ColorBy::Strain;
        largest_ = std::max(largest_, values.cwiseAbs().maxCoeff());
    }

    /// Around all surfaces; empty if there is none.
    [[nodiscard]] const Eigen::AlignedBox3d& box() const { return box_; }

    /// Of the colored quantity on them. One that is no wider than its rounding is a single value:
    /// for a strain a rounding of single precision, in which the simulator solves unless told
    /// otherwise, and for the others that of interpolated values, as w has on a slice across w.
    [[nodiscard]] ColorRange range() const {
        const double rounding = is_strain_
                                    ? static_cast<double>(std::numeric_limits<float>::epsilon())
                                    : 64 * std::numeric_limits<double>::epsilon() * largest_;
        const ColorRange range = range_.value_or(ColorRange());
        if (range.high - range.low > rounding) {
            return range;
        }
        const double middle = range.low + (range.high - range.low) / 2;
        const double value = std::abs(middle) > rounding ? middle : 0;
        return {value, value};
    }

private:
    Eigen::AlignedBox3d box_;
    std::optional<ColorRange> range_;
    double largest_ = 0;
    bool is_strain_ = false;
};

}  // namespace pent::viewer
