#pragma once

#include <pent/mesher/surface.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>

namespace pent::test {

/// A box as a clean outward surface of 8 points and 12 triangles.
inline mesher::Surface box_surface(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    mesher::Surface surface;
    surface.points.resize(3, 8);
    for (int i = 0; i < 8; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            surface.points(axis, i) = (i >> axis & 1) == 1 ? high[axis] : low[axis];
        }
    }
    surface.triangles.resize(3, 12);
    surface.triangles << 0, 0, 4, 4, 0, 0, 2, 2, 0, 0, 1, 1,  //
        2, 3, 5, 7, 1, 5, 6, 7, 4, 6, 3, 7,                   //
        3, 1, 7, 6, 5, 4, 7, 3, 6, 2, 7, 5;
    return surface;
}

/// Two surfaces side by side in one.
inline mesher::Surface join(const mesher::Surface& a, const mesher::Surface& b) {
    mesher::Surface both;
    both.points.resize(3, a.point_count() + b.point_count());
    both.points << a.points, b.points;
    both.triangles.resize(3, a.triangle_count() + b.triangle_count());
    both.triangles << a.triangles,
        (b.triangles.array() + static_cast<std::uint32_t>(a.point_count())).matrix();
    return both;
}

inline void write_file(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

}  // namespace pent::test
