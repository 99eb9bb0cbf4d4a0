#include "lattice_keys.h"
#include "lattice_tree.h"

#include <pent/parallel.h>

#include <algorithm>
#include <cmath>

namespace pent::mesher {

namespace {

using Ends = std::pair<std::uint32_t, std::uint32_t>;

constexpr std::uint32_t kTask = 64;  // cells or points

// Two sides of one wall look in opposite directions, to within 37 degrees.
constexpr double kOpposite = -0.8;

// What is thinner than this part of an edge is rounding, as where two bodies touch.
constexpr double kThinnest = 1e-6;

// Slopes of expressions are taken over this part of the spacing.
constexpr double kDifference = 1e-3;

template <typename Value>
void make_unique(std::vector<Value>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

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

// Edges that may go through the surface twice: both ends on one side, and near enough to it.
std::vector<Ends> LatticeTree::edges_to_search(double steepest) const {
    const auto add = [&](std::uint32_t a, std::uint32_t b, double reach, std::vector<Ends>& edges) {
        const bool is_same_side = (values_[a] < 0) == (values_[b] < 0);
        if (is_same_side && std::abs(values_[a]) + std::abs(values_[b]) < reach) {
            edges.emplace_back(a, b);
        }
    };
    const auto add_edges = [&](std::uint32_t cell, std::vector<Ends>& edges) {
        const double scale = std::ldexp(steepest, cells_[cell].size);
        const bool is_near =
            std::any_of(corners_[cell].begin(), corners_[cell].end(), [&](std::uint32_t corner) {
                return std::abs(values_[corner]) < scale * lattice_.longest_edge();
            });
        if (!is_near) {
            return;
        }
        if (halved_[cell] == kNone) {
            for (const CellEdge& edge : cell_edges()) {
                add(corners_[cell][edge.from], corners_[cell][edge.to],
                    scale * lattice_.spacing * edge.length, edges);
            }
            return;
        }
        visit_simplices(cell, [&](const Simplex& simplex, bool) {
            for (int i = 0; i < 5; ++i) {
                for (int j = i + 1; j < 5; ++j) {
                    add(simplex[i], simplex[j],
                        steepest * (place(simplex[j]) - place(simplex[i])).norm(), edges);
                }
            }
        });
    };
    const std::uint32_t tasks = (cell_count() + kTask - 1) / kTask;
    std::vector<std::vector<Ends>> found(tasks);
    parallel_for(tasks, 1U, [&](std::uint32_t task) {
        for (std::uint32_t i = task * kTask; i < std::min((task + 1) * kTask, cell_count()); ++i) {
            if (!cells_[i].is_inside) {
                add_edges(i, found[task]);
            }
        }
        make_unique(found[task]);
    });
    std::vector<Ends> all;
    for (const std::vector<Ends>& edges : found) {
        all.insert(all.end(), edges.begin(), edges.end());
    }
    make_unique(all);
    return all;
}

// From each end the surface is as far away as the function says, in the direction of its slope.
ThinParts LatticeTree::find_thin_parts(const Solid& solid) const {
    const std::vector<Ends> edges = edges_to_search(solid.is_lipschitz() ? 1 : steepest());
    std::vector<std::uint32_t> points;
    for (const auto& [a, b] : edges) {
        points.insert(points.end(), {a, b});
    }
    make_unique(points);
    std::vector<ValueSlope> found(points.size());
    parallel_for(points.size(), std::size_t{kTask}, [&](std::size_t i) {
        found[i] = solid.value_slope(place(points[i]), kDifference * lattice_.spacing);
    });
    const auto at = [&](std::uint32_t point) -> const ValueSlope& {
        return found[static_cast<std::size_t>(std::lower_bound(points.begin(), points.end(), point)
                                              - points.begin())];
    };
    ThinParts thin;
    for (const auto& [a, b] : edges) {
        const double steep_a = at(a).slope.norm();
        const double steep_b = at(b).slope.norm();
        const Eigen::Vector4d outward_a = at(a).slope / steep_a;
        const Eigen::Vector4d outward_b = at(b).slope / steep_b;
        if (!(outward_a.dot(outward_b) < kOpposite)) {
            continue;
        }
        const double side = at(a).value < 0 ? 1 : -1;
        const Eigen::Vector4d across = side * (outward_a - outward_b).normalized();
        const Eigen::Vector4d way = place(b) - place(a);
        const double width =
            across.dot(way) - std::abs(at(a).value) / steep_a - std::abs(at(b).value) / steep_b;
        if (width > kThinnest * way.norm()) {
            ++thin.edges;
            if (width < thin.width) {
                thin.width = width;
                thin.place = (place(a) + place(b)) / 2;
            }
        }
    }
    return thin;
}

}  // namespace pent::mesher
