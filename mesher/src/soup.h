#pragma once

#include "cells.h"

#include <pent/simplex_mesh.h>

#include <cstdint>
#include <span>
#include <vector>

namespace pent::mesher {

/// Points and triangles as a file lists them.
struct TriangleSoup {
    Positions<3> points;     ///< 3 x n, finite.
    Simplices<3> triangles;  ///< Indices in range.
    CellCounts left_out{};   ///< Lines and points of the file.
};

/// Collects points and polygons one by one, and cuts the polygons into triangles.
class SoupBuilder {
public:
    void add_point(const Eigen::Vector3d& point) { points_.push_back(point); }

    /// Cuts a polygon into a fan, from the first corner that turns no triangle over.
    /// @param polygon  Three corners or more, each an index of a point added before.
    void add_polygon(std::span<const std::uint32_t> polygon);

    /// Counts a line or a point, which is no part of a surface.
    void leave_out(CellKind kind) { ++left_out_[static_cast<std::size_t>(kind)]; }

    [[nodiscard]] std::int64_t point_count() const {
        return static_cast<std::int64_t>(points_.size());
    }

    [[nodiscard]] TriangleSoup soup() const;

private:
    [[nodiscard]] std::size_t fan_start(std::span<const std::uint32_t> polygon) const;

    std::vector<Eigen::Vector3d> points_;
    std::vector<std::uint32_t> corners_;  // three a triangle
    CellCounts left_out_{};
};

}  // namespace pent::mesher
