#include "surface_mesh.h"

#include <algorithm>
#include <array>
#include <limits>
#include <set>

namespace pent::mesher {

namespace {

// After one sweep most shapes have no bad cell left that can be improved, after five nearly all; in
// the others vertices move to and fro from then on.
constexpr int kMaxSweeps = 12;

// A vertex moves only if the quality of the worst cell around it grows by this part: less is not
// worth the sweeps that follow. With 0.03 cells stay worse.
constexpr double kWorthIt = 1e-3;

// Steps along the gradient of the worst cell's quality, in mean edges at the vertex: one after the
// other, until the worst cell is better. With the first alone the worst cells of shapes stay a
// tenth worse, with three a few percent more edges stay across ridges; to begin with a step twice
// or half as long makes little difference.
constexpr std::array<double, 5> kUphill = {0.4, 0.2, 0.1, 0.05, 0.025};

// Then towards the middle of the neighbors, in parts of the way there. Without these steps, too, a
// few percent more edges stay across ridges.
constexpr std::array<double, 2> kInwards = {0.5, 0.2};

class Relaxation {
public:
    Relaxation(SurfaceMesh& surface, double target)
        : surface_(surface), target_(target), settled_(surface.mesh.vertex_count(), kNever) {}

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
                    // What has failed would fail again where nothing around has changed.
                    const std::uint32_t change = surface_.mesh.change(vertex);
                    if (settled_[vertex] == change) {
                        continue;
                    }
                    if (improve(vertex)) {
                        touched.insert(vertex);
                    } else {
                        settled_[vertex] = change;
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
        const Eigen::Vector4d slope = mesh.quality_slope(worst_cell, vertex).normalized();
        const double mean_edge = edge / corners;
        bool has_moved = false;
        const auto attempt = [&](const Eigen::Vector4d& step) {
            if (!step.allFinite()) {
                return false;
            }
            const auto place = slide(surface_, vertex, mesh.place(vertex) + step);
            if (!place) {
                return false;
            }
            const double quality = mesh.quality_if_moved(vertex, *place).least;
            if (quality <= least * (1 + kWorthIt)) {
                return false;
            }
            surface_.mesh.move(vertex, *place);
            least = quality;
            has_moved = true;
            return true;
        };
        for (const double part : kUphill) {
            if (attempt(part * mean_edge * slope)) {
                break;
            }
        }
        for (const double part : kInwards) {
            if (attempt(part / corners * sum)) {
                break;
            }
        }
        return has_moved;
    }

    static constexpr std::uint32_t kNever = std::numeric_limits<std::uint32_t>::max();

    SurfaceMesh& surface_;
    double target_;
    // Of vertices for which nothing better was found: StarMesh::change() then.
    std::vector<std::uint32_t> settled_;
};

}  // namespace

void relax(SurfaceMesh& surface, double target) {
    Relaxation(surface, target).run();
}

}  // namespace pent::mesher
