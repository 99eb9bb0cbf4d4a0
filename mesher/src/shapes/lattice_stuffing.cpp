#include "lattice_stuffing.h"

#include "surface_search.h"

#include <pent/error.h>
#include <pent/parallel.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

namespace pent::mesher {

namespace {

constexpr std::uint32_t kNone = LatticeTree::kNone;
constexpr std::uint32_t kTask = 64;  // cells

// A point moves if the surface cuts an edge this near to it, in parts of the edge, or of the
// longest edge of the smallest cell there where that is shorter.
constexpr double kNear = 0.35;

// Cuts near points that moved back are kept this far from the ends, or cells would become flat.
constexpr double kMinPart = 0.05;

using Piece = std::array<CutCorner, 5>;

int pattern_of(const std::array<Side, 5>& sides) {
    int pattern = 0;
    for (const Side side : sides) {
        pattern = 3 * pattern + static_cast<int>(side) + 1;
    }
    return pattern;
}

// The pieces of every pattern of sides, for simplices that are not odd and for those that are.
struct PieceTable {
    std::array<std::vector<Piece>, 243> even;
    std::array<std::vector<Piece>, 243> odd;

    PieceTable() {
        for (int code = 0; code < 243; ++code) {
            std::array<Side, 5> sides{};
            for (int i = 4, rest = code; i >= 0; --i, rest /= 3) {
                sides[i] = static_cast<Side>(rest % 3 - 1);
            }
            for (const CutPiece& corners : cut_simplex({sides.begin(), sides.end()})) {
                Piece piece;
                std::copy(corners.begin(), corners.end(), piece.begin());
                even[code].push_back(piece);
                std::swap(piece[0], piece[1]);
                odd[code].push_back(piece);
            }
        }
    }
};

const PieceTable& pieces() {
    static const PieceTable table;
    return table;
}

std::uint32_t task_count(const LatticeTree& tree) {
    return (tree.cell_count() + kTask - 1) / kTask;
}

template <typename Visit>
void visit_simplices(const LatticeTree& tree, std::uint32_t task, const Visit& visit) {
    const std::uint32_t end = std::min((task + 1) * kTask, tree.cell_count());
    for (std::uint32_t cell = task * kTask; cell < end; ++cell) {
        tree.visit_simplices(cell, visit);
    }
}

}  // namespace

LatticeStuffing::LatticeStuffing(const Solid& solid, const LatticeTree& tree)
    : solid_(&solid), tree_(&tree) {
    sides_.resize(tree.point_count());
    for (std::uint32_t point = 0; point < tree.point_count(); ++point) {
        sides_[point] = tree.value(point) < 0 ? Side::Inside : Side::Outside;
    }
    find_edges();
    find_cuts();
    move_points();
}

void LatticeStuffing::find_edges() {
    using Ends = std::pair<std::uint32_t, std::uint32_t>;
    const auto make_unique = [](std::vector<Ends>& edges) {
        std::sort(edges.begin(), edges.end());
        edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    };
    std::vector<std::vector<Ends>> found(task_count(*tree_));
    parallel_for(task_count(*tree_), 1U, [&](std::uint32_t task) {
        std::vector<Ends>& edges = found[task];
        visit_simplices(*tree_, task, [&](const Simplex& simplex, bool) {
            for (int i = 0; i < 5; ++i) {
                for (int j = i + 1; j < 5; ++j) {
                    if (sides_[simplex[i]] != sides_[simplex[j]]) {
                        edges.emplace_back(simplex[i], simplex[j]);
                    }
                }
            }
        });
        make_unique(edges);
    });
    std::vector<Ends> all;
    for (std::vector<Ends>& edges : found) {
        all.insert(all.end(), edges.begin(), edges.end());
        edges = {};
    }
    make_unique(all);
    first_edge_.assign(tree_->point_count() + 1, 0);
    for (const auto& [from, to] : all) {
        edges_.push_back({from, to});
        ++first_edge_[from + 1];
    }
    for (std::uint32_t point = 0; point < tree_->point_count(); ++point) {
        first_edge_[point + 1] += first_edge_[point];
    }
}

void LatticeStuffing::find_cuts() {
    parallel_for(edges_.size(), std::size_t{kTask}, [&](std::size_t i) {
        Edge& edge = edges_[i];
        edge.cut = zero_between(*solid_, {tree_->place(edge.from), tree_->value(edge.from)},
                                {tree_->place(edge.to), tree_->value(edge.to)});
    });
}

void LatticeStuffing::move_points() {
    // Decided from the cuts alone, so that the order of the points does not matter.
    const std::vector<std::uint32_t> nearest = nearest_edges();
    for (std::uint32_t point = 0; point < tree_->point_count(); ++point) {
        if (nearest[point] != kNone) {
            moves_.push_back({point, {}});
        }
    }
    parallel_for(moves_.size(), std::size_t{kTask}, [&](std::size_t i) {
        moves_[i].place = moved(moves_[i].point, edges_[nearest[moves_[i].point]]);
    });
    for (const Move& move : moves_) {
        sides_[move.point] = Side::On;
    }
}

// For each point the edge whose cut is nearest, in parts of its length, if it is near.
std::vector<std::uint32_t> LatticeStuffing::nearest_edges() const {
    std::vector<std::uint32_t> nearest(tree_->point_count(), kNone);
    std::vector<double> least(tree_->point_count(), kNear);
    for (std::uint32_t i = 0; i < edges_.size(); ++i) {
        const Edge& edge = edges_[i];
        const double length = (tree_->place(edge.to) - tree_->place(edge.from)).norm();
        const auto consider = [&](std::uint32_t point, double part) {
            const double smallest = std::ldexp(tree_->lattice().longest_edge(), tree_->size(point));
            const double near = part * std::max(1.0, length / smallest);
            if (near < least[point]) {
                least[point] = near;
                nearest[point] = i;
            }
        };
        consider(edge.from, edge.cut);
        consider(edge.to, 1 - edge.cut);
    }
    return nearest;
}

// Straight to the surface, unless the way along the slope is longer than that to the cut.
Eigen::Vector4d LatticeStuffing::moved(std::uint32_t point, const Edge& edge) const {
    const Eigen::Vector4d place = tree_->place(point);
    const Eigen::Vector4d from = tree_->place(edge.from);
    const Eigen::Vector4d cut = from + edge.cut * (tree_->place(edge.to) - from);
    const double to_cut = (cut - place).norm();
    const std::optional<Eigen::Vector4d> foot =
        nearest_zero(*solid_, place, std::ldexp(tree_->lattice().spacing, tree_->size(point)));
    return foot && (*foot - place).norm() <= to_cut ? *foot : cut;
}

std::uint32_t LatticeStuffing::edge_between(std::uint32_t from, std::uint32_t to) const {
    const auto begin = edges_.begin() + first_edge_[from];
    const auto end = edges_.begin() + first_edge_[from + 1];
    const auto found = std::find_if(begin, end, [&](const Edge& edge) { return edge.to == to; });
    assert(found != end);
    return static_cast<std::uint32_t>(found - edges_.begin());
}

// Points inside, and those on the surface that share a simplex with one.
std::vector<std::uint8_t> LatticeStuffing::used_points() const {
    std::vector<std::uint8_t> is_used(tree_->point_count(), 0);
    for (std::uint32_t task = 0; task < task_count(*tree_); ++task) {
        visit_simplices(*tree_, task, [&](const Simplex& simplex, bool) {
            const bool has_inside =
                std::any_of(simplex.begin(), simplex.end(),
                            [&](std::uint32_t point) { return sides_[point] == Side::Inside; });
            for (const std::uint32_t point : simplex) {
                if (has_inside && sides_[point] != Side::Outside) {
                    is_used[point] = 1;
                }
            }
        });
    }
    return is_used;
}

// Calls visit(simplex, pieces) for every simplex of a task that has a part inside.
template <typename Visit>
void LatticeStuffing::visit_pieces(std::uint32_t task, const Visit& visit) const {
    visit_simplices(*tree_, task, [&](const Simplex& simplex, bool is_odd) {
        std::array<Side, 5> sides{};
        for (int i = 0; i < 5; ++i) {
            sides[i] = sides_[simplex[i]];
        }
        const int pattern = pattern_of(sides);
        const auto& list = is_odd ? pieces().odd[pattern] : pieces().even[pattern];
        if (!list.empty()) {
            visit(simplex, list);
        }
    });
}

void LatticeStuffing::number_vertices() {
    is_used_ = used_points();
    numbering_.points.assign(tree_->point_count(), 0);
    numbering_.cuts.assign(edges_.size(), kNone);
    std::uint64_t count = 0;
    for (std::uint32_t point = 0; point < tree_->point_count(); ++point) {
        numbering_.points[point] = static_cast<std::uint32_t>(count);
        count += is_used_[point];
        for (std::uint32_t i = first_edge_[point]; i < first_edge_[point + 1]; ++i) {
            if (is_cut(edges_[i])) {
                numbering_.cuts[i] = static_cast<std::uint32_t>(count++);
            }
        }
    }
    if (count > std::numeric_limits<std::uint32_t>::max()) {
        throw Error("a mesh of " + std::to_string(count)
                    + " vertices; expected at most 2^32 - 1: ask for longer edges");
    }
    numbering_.vertices = static_cast<std::uint32_t>(count);
    const std::uint32_t tasks = task_count(*tree_);
    numbering_.first_cell.assign(tasks + 1, 0);
    parallel_for(tasks, 1U, [&](std::uint32_t task) {
        std::uint64_t cells = 0;
        visit_pieces(task,
                     [&](const Simplex&, const std::vector<Piece>& list) { cells += list.size(); });
        numbering_.first_cell[task + 1] = cells;
    });
    for (std::uint32_t task = 0; task < tasks; ++task) {
        numbering_.first_cell[task + 1] += numbering_.first_cell[task];
    }
}

void LatticeStuffing::write_vertices(StuffedMesh& result) const {
    result.mesh.positions.resize(4, numbering_.vertices);
    result.is_on_surface.assign(numbering_.vertices, true);
    result.sizes.assign(numbering_.vertices, 0);
    auto move = moves_.begin();
    for (std::uint32_t point = 0; point < tree_->point_count(); ++point) {
        const bool has_moved = move != moves_.end() && move->point == point;
        if (is_used_[point] != 0) {
            const std::uint32_t vertex = numbering_.points[point];
            result.mesh.positions.col(vertex) =
                has_moved && sides_[point] == Side::On ? move->place : tree_->place(point);
            result.is_on_surface[vertex] = sides_[point] == Side::On;
            result.sizes[vertex] = static_cast<std::uint8_t>(tree_->size(point));
        }
        move += has_moved ? 1 : 0;
    }
    for (std::size_t i = 0; i < edges_.size(); ++i) {
        const std::uint32_t vertex = numbering_.cuts[i];
        if (vertex != kNone) {
            const Edge& edge = edges_[i];
            const Eigen::Vector4d from = tree_->place(edge.from);
            const double part = std::clamp(edge.cut, kMinPart, 1 - kMinPart);
            result.mesh.positions.col(vertex) = from + part * (tree_->place(edge.to) - from);
            result.sizes[vertex] =
                static_cast<std::uint8_t>(std::min(tree_->size(edge.from), tree_->size(edge.to)));
        }
    }
}

void LatticeStuffing::write_cells(std::uint32_t task, SimplexMesh<4>& mesh) const {
    auto cell = static_cast<Eigen::Index>(numbering_.first_cell[task]);
    visit_pieces(task, [&](const Simplex& simplex, const std::vector<Piece>& list) {
        for (const Piece& piece : list) {
            for (int i = 0; i < 5; ++i) {
                const auto [low, high] = std::minmax(piece[i].inside, piece[i].outside);
                mesh.cells(i, cell) =
                    low == high ? numbering_.points[simplex[low]]
                                : numbering_.cuts[edge_between(simplex[low], simplex[high])];
            }
            ++cell;
        }
    });
}

StuffedMesh LatticeStuffing::mesh() {
    number_vertices();
    StuffedMesh result;
    write_vertices(result);
    result.mesh.cells.resize(5, static_cast<Eigen::Index>(numbering_.first_cell.back()));
    parallel_for(task_count(*tree_), 1U,
                 [&](std::uint32_t task) { write_cells(task, result.mesh); });
    return result;
}

std::int64_t LatticeStuffing::move_back(const std::vector<bool>& vertices) {
    std::int64_t count = 0;
    for (const Move& move : moves_) {
        const std::uint32_t point = move.point;
        if (sides_[point] == Side::On && is_used_[point] != 0
            && vertices[numbering_.points[point]]) {
            sides_[point] = tree_->value(point) < 0 ? Side::Inside : Side::Outside;
            ++count;
        }
    }
    return count;
}

}  // namespace pent::mesher
