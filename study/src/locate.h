#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace pent::study {

/// Values at points of one mesh from values at the vertices of another, linear in each cell.
struct Interpolation {
    /// Corners of the cell each point is in, (dim + 1) x points; empty: vertex i is point i.
    Eigen::Matrix<std::uint32_t, -1, -1> corners;
    Eigen::MatrixXd weights;  ///< (dim + 1) x points; each column adds up to 1.
    double farthest = 0;  ///< Most negative weight there is, as a positive number: how far points
                          ///< lie outside of all cells, in cell heights.

    /// dim x points from dim x vertices.
    [[nodiscard]] Eigen::MatrixXd operator()(const Eigen::MatrixXd& values) const;
};

/// Finds each point in a mesh; one outside of it is extrapolated from the cell it is nearest to by
/// barycentric coordinates, among those whose boxes are near. Linear in points and cells.
///
/// @param points    dim x points, m.
/// @param vertices  dim x vertices, m.
/// @param cells     (dim + 1) x cells.
[[nodiscard]] Interpolation locate(const Eigen::MatrixXd& points,
                                   const Eigen::MatrixXd& vertices,
                                   const Eigen::Matrix<std::uint32_t, -1, -1>& cells);

}  // namespace pent::study
