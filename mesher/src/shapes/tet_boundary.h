#pragma once

#include "tet_tree.h"

#include <pent/exchange/tet_surface.h>

#include <cstdint>
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

    /// The same with its slope: away from the nearest point, or, there, along the normal.
    [[nodiscard]] ValueSlope value_slope(const Eigen::Vector4d& p) const;

    /// Patches are parts whose tetrahedra meet at less than 40 degrees.
    [[nodiscard]] int patch_count() const { return static_cast<int>(patches_.size()); }

    /// Height over the nearest tetrahedron of a patch, m.
    [[nodiscard]] double patch_value(int patch, const Eigen::Vector4d& p) const;

    /// The same with its slope: the normal of that tetrahedron.
    [[nodiscard]] ValueSlope patch_slope(int patch, const Eigen::Vector4d& p) const;

    /// The patches within a distance (m) of a point, ascending.
    [[nodiscard]] std::vector<int> patches_within(const Eigen::Vector4d& p, double distance) const;

    /// Tetrahedra with the body, or none of it, on both sides.
    [[nodiscard]] std::int64_t inner_count() const { return inner_count_; }

private:
    [[nodiscard]] Eigen::Matrix4d corners_of(const exchange::TetSurface& surface,
                                             std::uint32_t tetrahedron) const;
    [[nodiscard]] double signed_distance(const Eigen::Vector4d& there,
                                         const NearestPoint& nearest) const;
    [[nodiscard]] int crossings(const Eigen::Vector4d& from, std::uint32_t without) const;
    [[nodiscard]] bool separates(std::uint32_t tetrahedron, const Eigen::Matrix4d& corners) const;
    void plant(const exchange::TetSurface& surface, const std::vector<bool>& is_outer);

    // All in axes of its own, so that no ray runs along what files have straight.
    Eigen::Matrix4d rotation_;
    TetTree all_;                           // for rays
    TetTree outer_;                         // for distances
    std::vector<TetTree> patches_;          // of the same
    std::vector<int> patch_of_;             // of tetrahedra; -1: none
    std::vector<Eigen::Vector4d> normals_;  // of tetrahedra: outward, of length 1 or 0
    std::int64_t inner_count_ = 0;
};

}  // namespace pent::mesher
