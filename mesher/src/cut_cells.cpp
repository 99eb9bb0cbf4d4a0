#include "cut_cells.h"

#include <pent/counted.h>
#include <pent/error.h>

#include <Eigen/LU>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace pent::mesher {

namespace {

using Tet = std::array<std::uint32_t, 4>;
using Triangle = std::array<std::uint32_t, 3>;

// A face of a cell: distinct neighbors around it, three or four unless it has collapsed.
std::vector<std::uint32_t> face_loop(const CellFace& face, std::span<const std::uint32_t> corners) {
    std::vector<std::uint32_t> loop;
    for (const int position : face) {
        if (position >= 0 && (loop.empty() || corners[position] != loop.back())) {
            loop.push_back(corners[position]);
        }
    }
    while (loop.size() > 1 && loop.front() == loop.back()) {
        loop.pop_back();
    }
    return loop;
}

// Hands every cell to `visit(kind, corners, index)`.
template <typename Visit>
void for_each_cell(const CellSoup& soup, Visit visit) {
    std::size_t at = 0;
    for (std::size_t cell = 0; cell < soup.kinds.size(); ++cell) {
        const std::size_t count = corners_of(soup.kinds[cell]);
        visit(soup.kinds[cell], std::span(soup.corners).subspan(at, count), cell);
        at += count;
    }
}

// A quadrilateral that triangles behind it cut along the diagonal between `ends`. Its own cell cuts
// it from its first vertex in the order, so that one of `ends` has to come before `others`.
struct Diagonal {
    std::array<std::uint32_t, 2> ends;
    std::array<std::uint32_t, 2> others;

    bool operator<(const Diagonal& right) const {
        return std::pair(ends, others) < std::pair(right.ends, right.others);
    }
    bool operator==(const Diagonal& right) const = default;
};

struct Faces {
    std::vector<Triangle> triangles;  // sorted, each sorted
    std::vector<std::array<std::uint32_t, 4>> quadrilaterals;
};

Faces collect_faces(const CellSoup& soup) {
    Faces faces;
    for_each_cell(soup, [&](CellKind kind, std::span<const std::uint32_t> corners, std::size_t) {
        for (const CellFace& face : faces_of(kind)) {
            const std::vector<std::uint32_t> loop = face_loop(face, corners);
            if (loop.size() == 3) {
                Triangle triangle{loop[0], loop[1], loop[2]};
                std::sort(triangle.begin(), triangle.end());
                faces.triangles.push_back(triangle);
            } else if (loop.size() == 4) {
                faces.quadrilaterals.push_back({loop[0], loop[1], loop[2], loop[3]});
            }
        }
    });
    std::sort(faces.triangles.begin(), faces.triangles.end());
    return faces;
}

std::vector<Diagonal> wanted_diagonals(const Faces& faces) {
    std::vector<Diagonal> wanted;
    for (const auto& quad : faces.quadrilaterals) {
        for (std::size_t left_out = 0; left_out < 4; ++left_out) {
            const std::uint32_t a = quad[(left_out + 1) % 4];
            const std::uint32_t b = quad[(left_out + 2) % 4];
            const std::uint32_t c = quad[(left_out + 3) % 4];
            Triangle triangle{a, b, c};
            std::sort(triangle.begin(), triangle.end());
            if (std::binary_search(faces.triangles.begin(), faces.triangles.end(), triangle)) {
                wanted.push_back({{std::min(a, c), std::max(a, c)},
                                  {std::min(b, quad[left_out]), std::max(b, quad[left_out])}});
            }
        }
    }
    std::sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    return wanted;
}

// An order of vertices in which every diagonal has one of its ends before its others; vertices of
// no diagonal are left out. A vertex is free to come next unless it is among the others of a
// diagonal of which no end has come yet. Taking a free vertex never blocks another one, so taking
// any free one until none is left meets all diagonals if some order does.
std::vector<std::uint32_t> order_for(const std::vector<Diagonal>& diagonals,
                                     const std::string& name) {
    struct Role {
        std::vector<std::size_t> end_of;  // diagonals
        int blocked_by = 0;               // number of diagonals
    };
    std::map<std::uint32_t, Role> roles;
    for (std::size_t d = 0; d < diagonals.size(); ++d) {
        for (int i = 0; i < 2; ++i) {
            roles[diagonals[d].ends[i]].end_of.push_back(d);
            ++roles[diagonals[d].others[i]].blocked_by;
        }
    }
    std::set<std::uint32_t> free;
    for (const auto& [vertex, role] : roles) {
        if (role.blocked_by == 0) {
            free.insert(vertex);
        }
    }
    std::vector<bool> is_met(diagonals.size(), false);
    std::vector<std::uint32_t> order;
    while (!free.empty()) {
        const std::uint32_t vertex = *free.begin();
        free.erase(free.begin());
        order.push_back(vertex);
        for (const std::size_t d : roles[vertex].end_of) {
            for (const std::uint32_t other : diagonals[d].others) {
                if (!is_met[d] && --roles[other].blocked_by == 0) {
                    free.insert(other);
                }
            }
            is_met[d] = true;
        }
    }
    const auto unmet = std::count(is_met.begin(), is_met.end(), false);
    if (unmet > 0) {
        throw Error(name + ": " + std::to_string(unmet)
                    + " quadrilateral faces lie against triangles that cut them along diagonals"
                      " which no common cut of their cells has; put pyramids between them, or write"
                      " tetrahedra");
    }
    return order;
}

// The place of each point in the order of the cut.
std::vector<std::uint32_t> rank_points(const CellSoup& soup, const std::string& name) {
    const std::vector<std::uint32_t> first = order_for(wanted_diagonals(collect_faces(soup)), name);
    std::vector<std::uint32_t> ranks(soup.points.size());
    std::iota(ranks.begin(), ranks.end(), static_cast<std::uint32_t>(first.size()));
    for (std::size_t place = 0; place < first.size(); ++place) {
        ranks[first[place]] = static_cast<std::uint32_t>(place);
    }
    return ranks;
}

bool has_repeated_corner(const Tet& tet) {
    Tet sorted = tet;
    std::sort(sorted.begin(), sorted.end());
    return std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
}

// Appends the tetrahedra of a cell, all oriented as the cell is.
void pull(CellKind kind,
          std::span<const std::uint32_t> corners,
          const std::vector<std::uint32_t>& ranks,
          std::vector<Tet>& tets) {
    const auto is_before = [&](std::uint32_t a, std::uint32_t b) { return ranks[a] < ranks[b]; };
    const std::uint32_t first = *std::min_element(corners.begin(), corners.end(), is_before);
    for (const CellFace& face : faces_of(kind)) {
        std::vector<std::uint32_t> loop = face_loop(face, corners);
        if (loop.size() < 3 || std::find(loop.begin(), loop.end(), first) != loop.end()) {
            continue;
        }
        std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end(), is_before),
                    loop.end());
        for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
            const Tet tet{first, loop[0], loop[i], loop[i + 1]};
            if (!has_repeated_corner(tet)) {
                tets.push_back(tet);
            }
        }
    }
}

double six_volume(const CellSoup& soup, const Tet& tet) {
    Eigen::Matrix3d edges;
    for (int i = 0; i < 3; ++i) {
        edges.col(i) = soup.points[tet[i + 1]] - soup.points[tet[0]];
    }
    return edges.determinant();
}

// Turns the tetrahedra of one cell over if together they are negative; whether all are positive
// then.
bool orient(const CellSoup& soup, std::span<Tet> tets, std::int64_t& turned_cells) {
    double sum = 0;
    for (const Tet& tet : tets) {
        sum += six_volume(soup, tet);
    }
    if (sum < 0) {
        ++turned_cells;
        for (Tet& tet : tets) {
            std::swap(tet[2], tet[3]);
        }
    }
    return !tets.empty() && std::all_of(tets.begin(), tets.end(), [&](const Tet& tet) {
        return six_volume(soup, tet) > 0;
    });
}

void refuse_uncut_kinds(const CellSoup& soup, const std::string& name) {
    const std::string uncut =
        list_counts(soup.counts, CellKind::PentagonalPrism, CellKind::Polyhedron);
    if (!uncut.empty()) {
        throw Error(name + ": " + uncut
                    + "; expected tetrahedra, pyramids, prisms over triangles and hexahedra");
    }
}

// Cells of which a tetrahedron would be inverted or flat.
class Warped {
public:
    void note(CellKind kind, std::size_t cell) {
        first_ = first_ < 0 ? static_cast<std::int64_t>(cell) : first_;
        ++counts_[static_cast<std::size_t>(kind)];
    }

    void refuse(const CellSoup& soup, const std::string& name) const {
        if (first_ >= 0) {
            const auto refused = std::accumulate(counts_.begin(), counts_.end(), std::int64_t{0});
            throw Error(
                name + ": "
                + list_counts(counts_, CellKind::Tetrahedron, CellKind::Polyhedron) + " of "
                + counted(soup.kinds.size(), "cell", "cells")
                + (refused == 1 ? " is" : " are")
                + " too warped or flat to be cut: a tetrahedron of them would have no"
                  " volume or a negative one (first: cell "
                + std::to_string(first_) + ", from 0); smooth the mesh or write tetrahedra");
        }
    }

private:
    std::int64_t first_ = -1;
    CellCounts counts_{};
};

}  // namespace

CutCells cut_cells(const CellSoup& soup, const std::string& name) {
    refuse_uncut_kinds(soup, name);
    CutCells result;
    const bool are_all_tets = std::all_of(soup.kinds.begin(), soup.kinds.end(), [](CellKind kind) {
        return kind == CellKind::Tetrahedron;
    });
    const std::vector<std::uint32_t> ranks =
        are_all_tets ? std::vector<std::uint32_t>() : rank_points(soup, name);
    Warped warped;
    std::int64_t made = 0;
    for_each_cell(
        soup, [&](CellKind kind, std::span<const std::uint32_t> corners, std::size_t cell) {
            const std::size_t before = result.tets.size();
            if (kind == CellKind::Tetrahedron) {
                result.tets.push_back({corners[0], corners[1], corners[2], corners[3]});
                static_cast<void>(
                    orient(soup, std::span(result.tets).subspan(before), result.turned_cells));
            } else {
                pull(kind, corners, ranks, result.tets);
                made += static_cast<std::int64_t>(result.tets.size() - before);
                if (!orient(soup, std::span(result.tets).subspan(before), result.turned_cells)) {
                    warped.note(kind, cell);
                }
            }
            result.cells.resize(result.tets.size(), static_cast<std::uint32_t>(cell));
            if (soup.has_labels) {
                result.labels.resize(result.tets.size(), soup.labels[cell]);
            }
        });
    warped.refuse(soup, name);
    const std::string others = list_counts(soup.counts, CellKind::Pyramid, CellKind::Hexahedron);
    if (!others.empty()) {
        result.cut = others + " into " + counted(made, "tetrahedron", "tetrahedra");
    }
    return result;
}

}  // namespace pent::mesher
