#pragma once

#include <pent/viewer/coloring.h>
#include <pent/viewer/surface.h>

#include <Eigen/Geometry>

#include <optional>

namespace pent::viewer {

/// What holds for all that is shown in all frames, so that a movie has one scene and one color bar.
struct Survey {
    Eigen::AlignedBox3d box;          ///< Around all surfaces; empty if there is none.
    std::optional<ColorRange> range;  ///< Of the colored quantity on them.

    /// @param values  Of the colored quantity at the vertices of the surface.
    void add(const Surface& surface, const Eigen::VectorXd& values, ColorBy color) {
        if (surface.vertex_count() == 0) {
            return;
        }
        box.extend(bounding_box(surface));
        const ColorRange here = suitable_range(values, color);
        range = range ? joined(*range, here) : here;
    }
};

}  // namespace pent::viewer
