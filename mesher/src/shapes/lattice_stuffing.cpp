#include "lattice_stuffing.h"

#include "surface_search.h"

#include <pent/error.h>
#include <pent/parallel.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace pent::mesher {

namespace {

constexpr std::uint32_t kNone = LatticeGrid::kNone;
constexpr unsigned kBlock = LatticeGrid::kBlock;
constexpr unsigned kSteps = LatticeGrid::kSteps;
constexpr unsigned kAllSteps = 15;

// A point moves if the surface cuts an edge this near to it, in parts of the edge.
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

// The pieces of every pattern of sides, for paths that are not odd and for those that are.
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

const std::array<LatticePath, 24>& paths() {
    static const std::array<LatticePath, 24> all = lattice_paths();
    return all;
}

template <typename Work>
void for_blocks(const LatticeGrid& grid, const Work& work) {
    constexpr std::uint32_t kBlocks = 8;  // to a task
    parallel_for(grid.block_count(), kBlocks, work);
}

}  // namespace

LatticeStuffing::LatticeStuffing(const Solid& solid, const LatticeGrid& grid)
    : solid_(&solid), grid_(&grid) {
    sides_.resize(grid.point_count());
    for (std::uint32_t point = 0; point < grid.point_count(); ++point) {
        sides_[point] = grid.value(point) < 0 ? Side::Inside : Side::Outside;
    }
    find_cuts();
    move_points();
}

void LatticeStuffing::find_cuts() {
    steps_cut_.assign(grid_->point_count(), 0);
    first_cut_.assign(grid_->point_count(), 0);
    cuts_.resize(grid_->block_count());
    for_blocks(*grid_, [&](std::uint32_t block) {
        for (std::uint32_t point = block * kBlock; point < (block + 1) * kBlock; ++point) {
            find_cuts_of(point);
        }
    });
}

void LatticeStuffing::find_cuts_of(std::uint32_t point) {
    std::vector<double>& cuts = cuts_[point / kBlock];
    first_cut_[point] = static_cast<std::uint32_t>(cuts.size());
    const Side side = sides_[point];
    for (unsigned step = 1; step < kSteps; ++step) {
        const std::uint32_t other = grid_->after(point, step);
        if (other == kNone || sides_[other] == side) {
            continue;
        }
        steps_cut_[point] |= static_cast<std::uint16_t>(1U << step);
        const Eigen::Vector4d from = grid_->place(point);
        const Eigen::Vector4d to = grid_->place(other);
        cuts.push_back(
            zero_between(*solid_, {from, grid_->value(point)}, {to, grid_->value(other)}));
    }
}

void LatticeStuffing::move_points() {
    // Decided from the cuts alone, so that the order of the points does not matter.
    std::vector<std::uint8_t> is_moving(grid_->point_count(), 0);
    moved_.resize(grid_->block_count());
    for_blocks(*grid_, [&](std::uint32_t block) {
        for (std::uint32_t point = block * kBlock; point < (block + 1) * kBlock; ++point) {
            if (const std::optional<Eigen::Vector4d> cut = cut_near(point)) {
                is_moving[point] = 1;
                moved_[block].emplace_back(point, moved(point, *cut));
            }
        }
    });
    for (std::uint32_t point = 0; point < grid_->point_count(); ++point) {
        if (is_moving[point] != 0) {
            sides_[point] = Side::On;
        }
    }
}

// The nearest cut of an edge of a point, in parts of the edge, if it is near.
std::optional<Eigen::Vector4d> LatticeStuffing::cut_near(std::uint32_t point) const {
    double nearest = kNear;
    std::optional<Eigen::Vector4d> found;
    for (unsigned step = 1; step < kSteps; ++step) {
        const std::uint32_t owner = grid_->before(point, step);
        if (is_cut(point, step) && cut_part(point, step) < nearest) {
            nearest = cut_part(point, step);
            found = cut_place(point, step);
        }
        if (owner != kNone && is_cut(owner, step) && 1 - cut_part(owner, step) < nearest) {
            nearest = 1 - cut_part(owner, step);
            found = cut_place(owner, step);
        }
    }
    return found;
}

// Straight to the surface, unless the way along the slope is longer than that to the cut.
Eigen::Vector4d LatticeStuffing::moved(std::uint32_t point,
                                       const Eigen::Vector4d& nearest_cut) const {
    const Eigen::Vector4d place = grid_->place(point);
    const double reach = (nearest_cut - place).norm();
    const std::optional<Eigen::Vector4d> foot =
        nearest_zero(*solid_, place, grid_->lattice().spacing);
    return foot && (*foot - place).norm() <= reach ? *foot : nearest_cut;
}

bool LatticeStuffing::is_used(std::uint32_t point) const {
    if (sides_[point] != Side::On) {
        return sides_[point] == Side::Inside;
    }
    for (unsigned step = 1; step < kSteps; ++step) {
        if (side_of(grid_->after(point, step)) == Side::Inside
            || side_of(grid_->before(point, step)) == Side::Inside) {
            return true;
        }
    }
    return false;
}

// The steps along which the edge from a point is cut now: neither end has moved to the surface.
unsigned LatticeStuffing::cuts_from(std::uint32_t point) const {
    unsigned steps = steps_cut_[point];
    if (steps == 0 || sides_[point] == Side::On) {
        return 0;
    }
    for (unsigned step = 1; step < kSteps; ++step) {
        if ((steps >> step & 1U) != 0 && sides_[grid_->after(point, step)] == Side::On) {
            steps &= ~(1U << step);
        }
    }
    return steps;
}

double LatticeStuffing::cut_part(std::uint32_t point, unsigned step) const {
    const unsigned before = steps_cut_[point] & ((1U << step) - 1);
    return cuts_[point / kBlock][first_cut_[point] + static_cast<unsigned>(std::popcount(before))];
}

Eigen::Vector4d LatticeStuffing::cut_place(std::uint32_t point,
                                           unsigned step,
                                           double least_part) const {
    const double part = std::clamp(cut_part(point, step), least_part, 1 - least_part);
    const Eigen::Vector4d from = grid_->place(point);
    return from + part * (grid_->place(grid_->after(point, step)) - from);
}

// Calls visit(path, pieces, points of the cell by step) for every simplex at a point that has a
// part inside.
template <typename Visit>
void LatticeStuffing::visit_pieces(std::uint32_t point, const Visit& visit) const {
    std::array<std::uint32_t, kSteps> corners{};
    std::array<Side, kSteps> sides{};
    bool has_inside = false;
    for (unsigned step = 0; step < kSteps; ++step) {
        corners[step] = grid_->after(point, step);
        sides[step] = side_of(corners[step]);
        has_inside = has_inside || sides[step] == Side::Inside;
    }
    if (!has_inside) {
        return;
    }
    for (const LatticePath& path : paths()) {
        std::array<Side, 5> own{};
        for (int i = 0; i < 5; ++i) {
            own[i] = sides[path.steps[i]];
        }
        const int pattern = pattern_of(own);
        const auto& list = path.is_odd ? pieces().odd[pattern] : pieces().even[pattern];
        if (!list.empty()) {
            visit(path, list, corners);
        }
    }
}

void LatticeStuffing::number_vertices() {
    const std::uint32_t blocks = grid_->block_count();
    numbering_.vertices.assign(grid_->point_count(), 0);
    numbering_.first_vertex.assign(blocks + 1, 0);
    numbering_.first_cell.assign(blocks + 1, 0);
    std::vector<std::uint64_t> vertices(blocks + 1, 0);
    for_blocks(*grid_, [&](std::uint32_t block) {
        std::uint32_t count = 0;
        std::uint64_t cells = 0;
        for (std::uint32_t point = block * kBlock; point < (block + 1) * kBlock; ++point) {
            numbering_.vertices[point] = count;
            count += is_used(point) ? 1U : 0U;
            count += static_cast<std::uint32_t>(std::popcount(cuts_from(point)));
            visit_pieces(point, [&](const LatticePath&, const std::vector<Piece>& list,
                                    const auto&) { cells += list.size(); });
        }
        vertices[block + 1] = count;
        numbering_.first_cell[block + 1] = cells;
    });
    for (std::uint32_t block = 0; block < blocks; ++block) {
        vertices[block + 1] += vertices[block];
        numbering_.first_cell[block + 1] += numbering_.first_cell[block];
    }
    if (vertices.back() > std::numeric_limits<std::uint32_t>::max()) {
        throw Error("a mesh of " + std::to_string(vertices.back())
                    + " vertices; expected at most 2^32 - 1: ask for longer edges");
    }
    std::copy(vertices.begin(), vertices.end(), numbering_.first_vertex.begin());
    for_blocks(*grid_, [&](std::uint32_t block) {
        for (std::uint32_t point = block * kBlock; point < (block + 1) * kBlock; ++point) {
            numbering_.vertices[point] += numbering_.first_vertex[block];
        }
    });
}

void LatticeStuffing::write_vertices(std::uint32_t block, StuffedMesh& result) const {
    auto next_moved = moved_[block].begin();
    for (std::uint32_t point = block * kBlock; point < (block + 1) * kBlock; ++point) {
        Eigen::Vector4d place = grid_->place(point);
        while (next_moved != moved_[block].end() && next_moved->first <= point) {
            if (next_moved->first == point && sides_[point] == Side::On) {
                place = next_moved->second;
            }
            ++next_moved;
        }
        std::uint32_t vertex = numbering_.vertices[point];
        if (is_used(point)) {
            result.mesh.positions.col(vertex++) = place;
        }
        const unsigned steps = cuts_from(point);
        for (unsigned step = 1; step < kSteps; ++step) {
            if ((steps >> step & 1U) != 0) {
                result.mesh.positions.col(vertex++) = cut_place(point, step, kMinPart);
            }
        }
    }
}

void LatticeStuffing::write_cells(std::uint32_t block, SimplexMesh<4>& mesh) const {
    auto cell = static_cast<Eigen::Index>(numbering_.first_cell[block]);
    const auto vertex_of = [&](const LatticePath& path, const CutCorner& corner,
                               const std::array<std::uint32_t, kSteps>& corners) {
        const unsigned low = path.steps[std::min(corner.inside, corner.outside)];
        const std::uint32_t owner = corners[low];
        const std::uint32_t first = numbering_.vertices[owner];
        if (corner.inside == corner.outside) {
            return first;
        }
        const unsigned step = path.steps[std::max(corner.inside, corner.outside)] & ~low;
        const unsigned before = cuts_from(owner) & ((1U << step) - 1);
        return first + (is_used(owner) ? 1U : 0U)
               + static_cast<std::uint32_t>(std::popcount(before));
    };
    for (std::uint32_t point = block * kBlock; point < (block + 1) * kBlock; ++point) {
        visit_pieces(point, [&](const LatticePath& path, const std::vector<Piece>& list,
                                const std::array<std::uint32_t, kSteps>& corners) {
            for (const Piece& piece : list) {
                for (int i = 0; i < 5; ++i) {
                    mesh.cells(i, cell) = vertex_of(path, piece[i], corners);
                }
                ++cell;
            }
        });
    }
}

StuffedMesh LatticeStuffing::mesh() {
    number_vertices();
    StuffedMesh result;
    result.mesh.positions.resize(4, numbering_.first_vertex.back());
    result.mesh.cells.resize(5, static_cast<Eigen::Index>(numbering_.first_cell.back()));
    for_blocks(*grid_, [&](std::uint32_t block) {
        write_vertices(block, result);
        write_cells(block, result.mesh);
    });
    result.is_on_surface.assign(result.mesh.vertex_count(), true);
    for (std::uint32_t point = 0; point < grid_->point_count(); ++point) {
        if (sides_[point] == Side::Inside) {
            result.is_on_surface[numbering_.vertices[point]] = false;
        }
    }
    return result;
}

std::int64_t LatticeStuffing::move_back(const std::vector<bool>& vertices) {
    std::vector<std::uint32_t> points;
    for (std::uint32_t point = 0; point < grid_->point_count(); ++point) {
        if (sides_[point] == Side::On && is_used(point) && vertices[numbering_.vertices[point]]) {
            points.push_back(point);
        }
    }
    for (const std::uint32_t point : points) {
        sides_[point] = grid_->value(point) < 0 ? Side::Inside : Side::Outside;
    }
    return static_cast<std::int64_t>(points.size());
}

}  // namespace pent::mesher
