#pragma once

#include "tet_tree.h"

#include <pent/exchange/tet_surface.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace pent::mesher {

/// A closed hypersurface of tetrahedra that answers where points are. Safe to ask from several
/// threads.
class TetBoundary {
public:
    /// @param surface  A cycle, see closed_boundary().
    explicit TetBoundary(const exchange::TetSurface& surface);

    /// How often the hypersurface winds around a point, exactly: by the tetrahedra that a ray
    /// crosses. For a body whose boundary is outward 1 inside and 0 outside.
    [[nodiscard]] int winding_number(const Eigen::Vector4d& p) const;

    /// Distance from the nearest tetrahedron that has the body on one side, m; negative inside, 0
    /// where it is no more than rounding.
    [[nodiscard]] double value(const Eigen::Vector4d& p) const;

    /// The same, or `enough` (m) with its sign where it is further from 0. The ball around a point
    /// without a tetrahedron in it and that around one that is known are on the same side if they
    /// meet; else it takes a ray.
    /// @param known  The value at points near by, or `enough` with its sign.
    [[nodiscard]] double value_near(const Eigen::Vector4d& p,
                                    double enough,
                                    std::span<const Sample> known) const;

    /// Bounds of the value within a ball.
    [[nodiscard]] ValueRange range(const Eigen::Vector4d& center, double radius) const;

    /// How far value() is from 0, m; infinite from `max_distance` on. It takes no ray.
    [[nodiscard]] double distance(
        const Eigen::Vector4d& p,
        double max_distance = std::numeric_limits<double>::infinity()) const;

    /// The nearest point of what value() is the distance from, or of one patch.
    [[nodiscard]] Eigen::Vector4d foot(const Eigen::Vector4d& p,
                                       int patch = TetTree::kAnyPatch) const;

    /// The part of the way from a point outside to another one at which the first tetrahedron is
    /// crossed: a place of the body's surface, as nothing winds around what is outside. Nothing if
    /// rounding hides it.
    [[nodiscard]] std::optional<double> first_crossing(const Eigen::Vector4d& outside,
                                                       const Eigen::Vector4d& to) const;

    /// value() with its slope: away from the nearest point, or, there, along the normal.
    [[nodiscard]] ValueSlope value_slope(const Eigen::Vector4d& p) const;

    /// Patches are parts whose tetrahedra meet at less than 40 degrees.
    [[nodiscard]] int patch_count() const { return patch_count_; }

    /// Height over the nearest tetrahedron of a patch, m.
    [[nodiscard]] double patch_value(int patch, const Eigen::Vector4d& p) const;

    /// The same with its slope: the normal of that tetrahedron.
    [[nodiscard]] ValueSlope patch_slope(int patch, const Eigen::Vector4d& p) const;

    /// The patches within a distance (m) of a point, ascending.
    [[nodiscard]] std::vector<int> patches_within(const Eigen::Vector4d& p, double distance) const;

    /// Tetrahedra with the body, or none of it, on both sides.
    [[nodiscard]] std::int64_t inner_count() const { return inner_count_; }

private:
    [[nodiscard]] double signed_distance(const Eigen::Vector4d& there,
                                         const NearestPoint& nearest) const;
    [[nodiscard]] int crossings(const Eigen::Vector4d& from, std::uint32_t without) const;
    [[nodiscard]] bool separates(std::uint32_t tetrahedron) const;
    void find_patches(const std::vector<std::uint8_t>& is_outer);

    // In axes of its own, so that no ray runs along what files have straight.
    Eigen::Matrix4d rotation_;
    TetTree tree_;
    int patch_count_ = 0;
    std::int64_t inner_count_ = 0;
};

}  // namespace pent::mesher
