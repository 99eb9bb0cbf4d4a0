#include "lattice_keys.h"
#include "lattice_tree.h"

#include <pent/parallel.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace pent::mesher {

namespace {

constexpr std::uint32_t kTask = 64;  // cells or points

// Two sides of one wall look in opposite directions, to within 37 degrees.
constexpr double kOpposite = -0.8;

// What is thinner than this part of an edge is rounding, as where two bodies touch.
constexpr double kThinnest = 1e-6;

// Slopes of expressions are taken over this part of the spacing.
constexpr double kDifference = 1e-3;

// An edge between corners of a cell, as sets of axes; its length in spacings.
struct CellEdge {
    unsigned from = 0;
    unsigned to = 0;
    double length = 0;
};

// Those along the paths.
const std::vector<CellEdge>& cell_edges() {
    static const std::vector<CellEdge> all = [] {
        std::vector<CellEdge> edges;
        for (unsigned from = 0; from < 16; ++from) {
            for (unsigned to = from + 1; to < 16; ++to) {
                if ((from & to) == from) {
                    edges.push_back({from, to, Lattice().point(unit_steps(to - from)).norm()});
                }
            }
        }
        return edges;
    }();
    return all;
}

}  // namespace

// How steep the function is, as it shows between points, where it need not be a distance.
double LatticeTree::steepest() const {
    double steepest = 0;
    for (std::uint32_t cell = 0; cell < cell_count(); ++cell) {
        if (cells_[cell].is_inside) {
            continue;
        }
        const auto& corners = corners_[cell];
        Eigen::Vector4d rises;
        for (int axis = 0; axis < 4; ++axis) {
            rises[axis] = values_[corners[1U << axis]] - values_[corners[0]];
        }
        // A slope takes steps of the lattice to rises as its points are taken to coordinates.
        const double slope = lattice_.coordinates(rises).norm();
        steepest = std::max(steepest, std::ldexp(slope, -cells_[cell].size));
    }
    return steepest;
}

// Calls visit(a, b) for edges that may go through the surface twice: both ends on one side, and
// together no further from it than from each other. An edge may come several times.
template <typename Visit>
void LatticeTree::visit_near_edges(std::uint32_t task,
                                   const std::vector<double>& distances,
                                   const Visit& visit) const {
    const auto add = [&](std::uint32_t a, std::uint32_t b, double length) {
        const bool is_same_side = (values_[a] < 0) == (values_[b] < 0);
        if (is_same_side && distances[a] + distances[b] < length) {
            visit(std::min(a, b), std::max(a, b));
        }
    };
    for (std::uint32_t cell = task * kTask; cell < std::min((task + 1) * kTask, cell_count());
         ++cell) {
        const auto& corners = corners_[cell];
        const double longest = std::ldexp(lattice_.longest_edge(), cells_[cell].size);
        if (cells_[cell].is_inside
            || std::none_of(corners.begin(), corners.end(),
                            [&](std::uint32_t corner) { return distances[corner] < longest; })) {
            continue;
        }
        if (halved_[cell] == kNone) {
            for (const CellEdge& edge : cell_edges()) {
                add(corners[edge.from], corners[edge.to],
                    std::ldexp(lattice_.spacing * edge.length, cells_[cell].size));
            }
            continue;
        }
        visit_simplices(cell, [&](const Simplex& simplex, bool) {
            for (int i = 0; i < 5; ++i) {
                for (int j = i + 1; j < 5; ++j) {
                    add(simplex[i], simplex[j], (place(simplex[j]) - place(simplex[i])).norm());
                }
            }
        });
    }
}

// The surface is as far away as the function says, in the direction of its slope. At first no
// further than where the function is steepest everywhere; then as it is at the ends of edges that
// are near so.
ThinParts LatticeTree::find_thin_parts(const Solid& solid) const {
    const double steep = solid.is_lipschitz() ? 1 : steepest();
    std::vector<double> distances(values_.size());
    std::transform(values_.begin(), values_.end(), distances.begin(),
                   [&](double value) { return std::abs(value) / steep; });
    const std::uint32_t tasks = (cell_count() + kTask - 1) / kTask;
    std::vector<std::uint8_t> is_end(values_.size(), 0);
    parallel_for(tasks, 1U, [&](std::uint32_t task) {
        visit_near_edges(task, distances, [&](std::uint32_t a, std::uint32_t b) {
            for (const std::uint32_t end : {a, b}) {
                std::atomic_ref(is_end[end]).store(1, std::memory_order_relaxed);
            }
        });
    });
    std::vector<std::uint32_t> points;
    for (std::uint32_t point = 0; point < point_count(); ++point) {
        if (is_end[point] != 0) {
            points.push_back(point);
        }
    }
    std::vector<Eigen::Vector4d> slopes(points.size());
    parallel_for(points.size(), std::size_t{kTask}, [&](std::size_t i) {
        const std::uint32_t point = points[i];
        slopes[i] = solid.slope({place(point), values_[point]}, kDifference * lattice_.spacing);
        distances[point] = std::abs(values_[point]) / slopes[i].norm();
    });
    const auto outward_at = [&](std::uint32_t point) -> Eigen::Vector4d {
        return slopes[static_cast<std::size_t>(std::lower_bound(points.begin(), points.end(), point)
                                               - points.begin())]
            .normalized();
    };
    std::vector<std::vector<ThinEdge>> found(tasks);
    parallel_for(tasks, 1U, [&](std::uint32_t task) {
        visit_near_edges(task, distances, [&](std::uint32_t a, std::uint32_t b) {
            const Eigen::Vector4d outward_a = outward_at(a);
            const Eigen::Vector4d outward_b = outward_at(b);
            if (!(outward_a.dot(outward_b) < kOpposite)) {
                return;
            }
            const double side = values_[a] < 0 ? 1 : -1;
            const Eigen::Vector4d across = side * (outward_a - outward_b).normalized();
            const Eigen::Vector4d way = place(b) - place(a);
            const double width = across.dot(way) - distances[a] - distances[b];
            if (width > kThinnest * way.norm()) {
                found[task].push_back({a, b, width});
            }
        });
    });
    return summary(found);
}

// Each edge once, the thinnest with its place.
ThinParts LatticeTree::summary(const std::vector<std::vector<ThinEdge>>& found) const {
    std::vector<ThinEdge> all;
    for (const std::vector<ThinEdge>& own : found) {
        all.insert(all.end(), own.begin(), own.end());
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    ThinParts thin;
    thin.edges = static_cast<std::int64_t>(all.size());
    for (const ThinEdge& edge : all) {
        if (edge.width < thin.width) {
            thin.width = edge.width;
            thin.place = (place(edge.a) + place(edge.b)) / 2;
        }
    }
    return thin;
}

}  // namespace pent::mesher
