#include "surface_mesh.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <limits>
#include <set>

namespace pent::mesher {

namespace {

constexpr int kMaxSweeps = 12;

// Slope of the logarithm of a cell's mean ratio over the place of one of its corners, 1/m.
Eigen::Vector4d quality_slope(const StarMesh& mesh, std::uint32_t cell, std::uint32_t vertex) {
    const std::array<std::uint32_t, 5>& corners = mesh.cell(cell);
    const Eigen::Vector4d& place = mesh.place(vertex);
    Eigen::Matrix4d edges;  // from the vertex
    double squares = 0;
    int column = 0;
    for (int i = 0; i < 5; ++i) {
        if (corners[i] != vertex) {
            edges.col(column++) = mesh.place(corners[i]) - place;
        }
        for (int j = 0; j < i; ++j) {
            squares += (mesh.place(corners[i]) - mesh.place(corners[j])).squaredNorm();
        }
    }
    // The volume's part: det(V)^(1/2) as the vertex moves all edges at once.
    const Eigen::Vector4d of_volume = -0.5 * edges.transpose().inverse() * Eigen::Vector4d::Ones();
    const Eigen::Vector4d of_edges = 2 * edges.rowwise().sum() / squares;
    return of_volume + of_edges;
}

class Relaxation {
public:
    Relaxation(SurfaceMesh& surface, double target) : surface_(surface), target_(target) {}

    void run() {
        std::vector<std::pair<double, std::uint32_t>> worst;
        for (std::uint32_t cell = 0; cell < surface_.mesh.cell_count(); ++cell) {
            note(cell, worst);
        }
        for (int sweep = 0; sweep < kMaxSweeps && !worst.empty(); ++sweep) {
            std::sort(worst.begin(), worst.end());
            std::set<std::uint32_t> touched;
            for (const auto& [quality, cell] : worst) {
                for (const std::uint32_t vertex : surface_.mesh.cell(cell)) {
                    if (improve(vertex)) {
                        touched.insert(vertex);
                    }
                }
            }
            if (touched.empty()) {
                break;
            }
            std::set<std::uint32_t> cells;
            for (const auto& [quality, cell] : worst) {
                cells.insert(cell);
            }
            for (const std::uint32_t vertex : touched) {
                cells.insert(surface_.mesh.star(vertex).begin(), surface_.mesh.star(vertex).end());
            }
            worst.clear();
            for (const std::uint32_t cell : cells) {
                note(cell, worst);
            }
        }
    }

private:
    void note(std::uint32_t cell, std::vector<std::pair<double, std::uint32_t>>& worst) const {
        const double quality = surface_.mesh.quality(cell);
        if (quality < target_) {
            worst.emplace_back(quality, cell);
        }
    }

    // Moves a vertex so that the worst cell around it is better; false if it is good enough or
    // stays.
    bool improve(std::uint32_t vertex) {
        const StarMesh& mesh = surface_.mesh;
        double least = std::numeric_limits<double>::infinity();
        std::uint32_t worst_cell = 0;
        Eigen::Vector4d sum = Eigen::Vector4d::Zero();
        double edge = 0;
        for (const std::uint32_t cell : mesh.star(vertex)) {
            const double quality = mesh.quality(cell);
            if (quality < least) {
                least = quality;
                worst_cell = cell;
            }
            for (const std::uint32_t corner : mesh.cell(cell)) {
                sum += mesh.place(corner) - mesh.place(vertex);
                edge += (mesh.place(corner) - mesh.place(vertex)).norm();
            }
        }
        if (least >= target_) {
            return false;
        }
        const auto corners = 4 * static_cast<double>(mesh.star(vertex).size());
        const Eigen::Vector4d slope = quality_slope(mesh, worst_cell, vertex).normalized();
        const double reach = edge / corners;
        bool has_moved = false;
        const auto attempt = [&](const Eigen::Vector4d& step) {
            if (!step.allFinite()) {
                return false;
            }
            Eigen::Vector4d place = mesh.place(vertex) + step;
            if (!surface_.pieces[vertex].empty()) {
                const auto there = slide(surface_, vertex, place);
                if (!there) {
                    return false;
                }
                place = *there;
            }
            const double quality = mesh.quality_if_moved(vertex, place);
            if (quality <= least * (1 + 1e-3)) {
                return false;
            }
            surface_.mesh.move(vertex, place);
            least = quality;
            has_moved = true;
            return true;
        };
        for (const double part : {0.4, 0.2, 0.1, 0.05, 0.025}) {
            if (attempt(part * reach * slope)) {
                break;
            }
        }
        for (const double part : {0.5, 0.2}) {
            if (attempt(part / corners * sum)) {
                break;
            }
        }
        return has_moved;
    }

    SurfaceMesh& surface_;
    double target_;
};

}  // namespace

void relax(SurfaceMesh& surface, double target) {
    Relaxation(surface, target).run();
}

}  // namespace pent::mesher
