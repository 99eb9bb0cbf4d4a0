#include "surface_readers.h"

#include <pent/error.h>
#include <pent/input_path.h>
#include <pent/mesher/read_surface.h>
#include <pent/surface_measures.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pent::mesher {

namespace {

constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

bool is_before(const Positions<3>& points, std::uint32_t a, std::uint32_t b) {
    for (int axis = 0; axis < 3; ++axis) {
        if (points(axis, a) != points(axis, b)) {
            return points(axis, a) < points(axis, b);
        }
    }
    return a < b;
}

// For each point the first one at the same place.
std::vector<std::uint32_t> first_at_same_place(const Positions<3>& points) {
    std::vector<std::uint32_t> order(points.cols());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return is_before(points, a, b); });
    std::vector<std::uint32_t> first(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool is_same = i > 0 && points.col(order[i]) == points.col(order[i - 1]);
        first[order[i]] = is_same ? first[order[i - 1]] : order[i];
    }
    return first;
}

TriangleSoup read_soup(const std::filesystem::path& path,
                       const std::string& given,
                       const StepLimits& limits) {
    require_file(path);
    const std::string format = format_of(path, given);
    constexpr std::array<
        std::pair<std::string_view, TriangleSoup (*)(const std::filesystem::path&)>, 4>
        kReaders = {
            {{".obj", read_obj}, {".off", read_off}, {".ply", read_ply}, {".stl", read_stl}}};
    if (format == ".gltf" || format == ".glb") {
        return read_gltf(path, limits);
    }
    for (const auto& [known, read] : kReaders) {
        if (format == known) {
            return read(path);
        }
    }
    const std::string ending =
        format.empty() ? "a name without an ending" : "a name that ends in \"" + format + "\"";
    throw Error(input_name(path) + ": " + ending
                + "; surfaces end in .obj, .off, .ply, .stl, .gltf or .glb, tetrahedra in .node,"
                  " .ele, .mesh, .msh, .vtk, .vtu or .tobj; for others, and standard input, give"
                  " the format");
}

}  // namespace

SurfaceFile weld(const Positions<3>& points, const Simplices<3>& triangles) {
    const std::vector<std::uint32_t> first = first_at_same_place(points);
    SurfaceFile file;
    file.points_in_file = points.cols();
    std::vector<std::uint32_t> new_index(first.size(), kUnused);
    for (const std::uint32_t corner : triangles.reshaped()) {
        new_index[first[corner]] = 0;
    }
    std::uint32_t kept = 0;
    for (std::size_t i = 0; i < first.size(); ++i) {
        if (first[i] != i) {
            ++file.merged_points;
        } else if (new_index[i] == kUnused) {
            ++file.unused_points;
        } else {
            new_index[i] = kept++;
        }
    }
    file.surface.points.resize(3, kept);
    for (std::size_t i = 0; i < first.size(); ++i) {
        if (first[i] == i && new_index[i] != kUnused) {
            file.surface.points.col(new_index[i]) = points.col(static_cast<Eigen::Index>(i));
        }
    }
    file.surface.triangles =
        triangles.unaryExpr([&](std::uint32_t corner) { return new_index[first[corner]]; });
    return file;
}

SurfaceFile read_surface(const std::filesystem::path& path,
                         const std::string& format,
                         const StepLimits& limits) {
    const TriangleSoup soup = read_soup(path, format, limits);
    if (soup.triangles.cols() == 0) {
        throw Error(input_name(path) + ": no triangle in it; expected a surface");
    }
    SurfaceFile file = weld(soup.points, soup.triangles);
    file.left_out = list_counts(soup.left_out, CellKind::Line, CellKind::Point);
    return file;
}

SurfaceFile read_surface(const std::filesystem::path& path) {
    return read_surface(path, {}, {});
}

double area(const Surface& surface) {
    return triangle_area(surface.points, surface.triangles);
}

double enclosed_volume(const Surface& surface) {
    return pent::enclosed_volume(surface.points, surface.triangles);
}

double diagonal(const Positions<3>& points) {
    return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
}

}  // namespace pent::mesher
