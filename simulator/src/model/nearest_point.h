#pragma once

#include "model/rotation.h"

#include <pent/contact/box_tree.h>
#include <pent/simplex_mesh.h>

#include <array>
#include <cstdint>
#include <optional>

namespace pent::simulator {

/// A point of a body, in a cell and by barycentric coordinates: it moves and deforms with the cell.
template <int Dim>
struct MaterialPoint {
    using Weights = Eigen::Matrix<double, Dim + 1, 1>;

    std::array<std::uint32_t, Dim + 1> vertices{};  ///< Corners of its cell.
    Weights weights = Weights::Zero();              ///< Of these; their sum is 1.
    double distance = 0;                            ///< From the point that was asked about, m.
};

/// Finds the point of some cells that is nearest to a point in space: within the cells that point
/// itself. By a tree, so that a search takes about as long in a million cells as in a thousand. In
/// two steps, as cells may be on several ranks.
template <int Dim>
class NearestPointSearch {
public:
    /// @param positions  Dim x vertices, m; kept by reference, and not to be changed.
    /// @param cells      The volume of none is 0.
    NearestPointSearch(const Positions<Dim>& positions, Simplices<Dim + 1> cells);

    /// How far the nearest point is, m; infinite where there is no cell.
    [[nodiscard]] double distance(const Vector<Dim>& point) const;

    /// The first of the cells that are as near as that, but for rounding; none where all are
    /// farther.
    [[nodiscard]] std::optional<Eigen::Index> first_at(const Vector<Dim>& point,
                                                       double distance) const;

    /// The nearest point of one cell. The weights are not negative, and exactly 0 for the corners
    /// that the nearest face lacks.
    [[nodiscard]] MaterialPoint<Dim> nearest_in(Eigen::Index cell, const Vector<Dim>& point) const;

private:
    [[nodiscard]] Eigen::Matrix<double, Dim, Dim + 1> corners(Eigen::Index cell) const;

    const Positions<Dim>& positions_;
    Simplices<Dim + 1> cells_;
    contact::BoxTree tree_;
};

/// Barycentric coordinates of any point in space, those of a cell extrapolated beyond its faces:
/// some are negative outside.
template <int Dim>
[[nodiscard]] typename MaterialPoint<Dim>::Weights barycentric(
    const Eigen::Matrix<double, Dim, Dim + 1>& corners, const Vector<Dim>& point);

}  // namespace pent::simulator
