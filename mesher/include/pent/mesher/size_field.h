#pragma once

#include <pent/geometry.h>

#include <Eigen/Core>

#include <limits>
#include <optional>

namespace pent::mesher {

/// How long the edges of a body may be, place by place: shortest at a hyperplane or a point, longer
/// away from it. Of one length everywhere if there is neither.
struct SizeField {
    std::optional<Hyperplane<4>> plane;
    std::optional<Eigen::Vector4d> point;  ///< Instead, m.
    double growth = 1;                     ///< m of edge for each m of distance, 0 or more.
    double longest = std::numeric_limits<double>::infinity();  ///< m.

    [[nodiscard]] bool is_uniform() const { return !plane && !point; }

    /// From the hyperplane or point, m; 0 if there is neither.
    [[nodiscard]] double distance(const Eigen::Vector4d& p) const;

    /// The longest mean edge allowed anywhere in a ball, m.
    /// @param shortest  Where it is shortest, m.
    [[nodiscard]] double edge_within(double shortest,
                                     const Eigen::Vector4d& center,
                                     double radius) const;
};

}  // namespace pent::mesher
