#pragma once

#include <pent/viewer/surface.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <utility>

namespace pent::viewer::test {

/// Succeeds if every edge has exactly two triangles, which run along it in opposite directions.
inline testing::AssertionResult is_closed_and_oriented(const TriangleMesh& surface) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (const auto& triangle : surface.triangles.colwise()) {
        for (int k = 0; k < 3; ++k) {
            ++uses[{triangle[k], triangle[(k + 1) % 3]}];
        }
    }
    for (const auto& [edge, count] : uses) {
        const auto reverse = uses.find({edge.second, edge.first});
        if (edge.first == edge.second || count != 1 || reverse == uses.end()
            || reverse->second != 1) {
            return testing::AssertionFailure()
                   << "edge " << edge.first << " " << edge.second << " is used " << count
                   << " times, " << (reverse == uses.end() ? 0 : reverse->second) << " in reverse";
        }
    }
    return testing::AssertionSuccess();
}

/// The smallest area of a triangle, m^2; infinite if there is none.
inline double smallest_area(const TriangleMesh& surface) {
    double smallest = std::numeric_limits<double>::infinity();
    for (const auto& triangle : surface.triangles.colwise()) {
        const Eigen::Vector3d a = surface.positions.col(triangle[0]);
        const Eigen::Vector3d b = surface.positions.col(triangle[1]);
        const Eigen::Vector3d c = surface.positions.col(triangle[2]);
        smallest = std::min(smallest, (b - a).cross(c - a).norm() / 2);
    }
    return smallest;
}

}  // namespace pent::viewer::test
