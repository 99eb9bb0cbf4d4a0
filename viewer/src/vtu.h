#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

namespace pent::viewer {

/// A grid of simplices in space, as ParaView takes it.
struct VtuGrid {
    struct PointData {
        std::string name;        ///< A word.
        Eigen::VectorXd values;  ///< One a point.
    };

    Eigen::Matrix3Xd points;                                             ///< 3 x n, m.
    Eigen::Matrix<std::uint32_t, Eigen::Dynamic, Eigen::Dynamic> cells;  ///< 3 or 4 corners x m.
    std::vector<PointData> point_data;
};

/// The bytes of a VTK XML unstructured grid, version 1.0, with raw appended data and 64-bit sizes.
/// Source: [vtkformats].
[[nodiscard]] std::string to_vtu(const VtuGrid& grid);

/// One file of a ParaView collection.
struct PvdEntry {
    double time = 0;   ///< s.
    std::string file;  ///< Relative to the collection.
};

/// The text of a ParaView collection: files over time.
[[nodiscard]] std::string to_pvd(const std::vector<PvdEntry>& entries);

}  // namespace pent::viewer
