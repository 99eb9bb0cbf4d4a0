#include "surface_mesh.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

namespace pent::mesher {

namespace {

constexpr int kSweeps = 2;

// Cells of a higher mean ratio are left as they are.
constexpr double kFine = 0.7;

// Corners of cells that are not fine and lie along a ridge.
std::vector<bool> corners_along_ridges(const SurfaceMesh& surface) {
    std::vector<bool> along(surface.mesh.vertex_count());
    for (std::uint32_t cell = 0; cell < surface.mesh.cell_count(); ++cell) {
        const auto& corners = surface.mesh.cell(cell);
        const bool is_along =
            std::any_of(corners.begin(), corners.end(),
                        [&](std::uint32_t corner) { return surface.pieces[corner].size() > 1; });
        if (is_along && surface.mesh.quality(cell) < kFine) {
            for (const std::uint32_t corner : corners) {
                along[corner] = true;
            }
        }
    }
    return along;
}

// Moves a vertex uphill, or towards the middle of its neighbors; false if neither is better.
bool improve(SurfaceMesh& surface, std::uint32_t vertex, double least) {
    const StarMesh& mesh = surface.mesh;
    StarQuality now;
    Eigen::Vector4d slope = Eigen::Vector4d::Zero();
    Eigen::Vector4d to_corners = Eigen::Vector4d::Zero();
    double lengths = 0;
    for (const std::uint32_t cell : mesh.star(vertex)) {
        const double quality = mesh.quality(cell);
        now.least = std::min(now.least, quality);
        now.sum += quality;
        slope += quality * mesh.quality_slope(cell, vertex);
        for (const std::uint32_t corner : mesh.cell(cell)) {
            to_corners += mesh.place(corner) - mesh.place(vertex);
            lengths += (mesh.place(corner) - mesh.place(vertex)).norm();
        }
    }
    const auto cells = static_cast<double>(mesh.star(vertex).size());
    const double mean_edge = lengths / (4 * cells);
    const auto attempt = [&](const Eigen::Vector4d& step) {
        constexpr double kWorthIt = 1e-4;  // of a cell's quality
        const auto place =
            step.allFinite() ? slide(surface, vertex, mesh.place(vertex) + step) : std::nullopt;
        if (!place) {
            return false;
        }
        const StarQuality then = mesh.quality_if_moved(vertex, *place);
        if (then.least < std::min(now.least, least) || then.sum <= now.sum + kWorthIt * cells) {
            return false;
        }
        surface.mesh.move(vertex, *place);
        return true;
    };
    for (const double part : {0.4, 0.2, 0.1, 0.05}) {
        if (attempt(part * mean_edge * slope.normalized())) {
            return true;
        }
    }
    return attempt(to_corners / (8 * cells));
}

}  // namespace

void smooth(SurfaceMesh& surface, double least) {
    // What has failed would fail again where nothing around has changed.
    constexpr std::uint32_t kNever = std::numeric_limits<std::uint32_t>::max();
    surface.settled.resize(surface.mesh.vertex_count(), kNever);
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        const std::vector<bool> along = corners_along_ridges(surface);
        for (std::uint32_t vertex = 0; vertex < surface.mesh.vertex_count(); ++vertex) {
            const std::uint32_t change = surface.mesh.change(vertex);
            if (along[vertex] && surface.settled[vertex] != change
                && !improve(surface, vertex, least)) {
                surface.settled[vertex] = change;
            }
        }
    }
}

}  // namespace pent::mesher
