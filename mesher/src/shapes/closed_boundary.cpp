#include "closed_boundary.h"

#include "../size_limits.h"
#include "../union_find.h"

#include <pent/equal_runs.h>
#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/geometry.h>

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <map>
#include <vector>

namespace pent::mesher {

namespace {

using Eigen::Vector4d;
using Tetrahedron = std::array<std::uint32_t, 4>;
using Triangle = std::array<std::uint32_t, 3>;

// The largest volume of what closes a hole, as a part of that of the boundary.
constexpr double kLargestHole = 0.25;

// Sorts corners; true if that turns the simplex over.
template <std::size_t Corners>
bool sort_corners(std::array<std::uint32_t, Corners>& corners) {
    bool is_odd = false;
    for (std::size_t end = Corners; end > 1; --end) {
        for (std::size_t i = 0; i + 1 < end; ++i) {
            if (corners[i] > corners[i + 1]) {
                std::swap(corners[i], corners[i + 1]);
                is_odd = !is_odd;
            }
        }
    }
    return is_odd;
}

// A triangle of a tetrahedron: its corners increasing, and the sign of the orientation that the
// tetrahedron induces on it.
struct Side {
    Triangle corners{};
    std::uint32_t tetrahedron = 0;
    int sign = 1;
};

std::vector<Side> sides_of(const std::vector<Tetrahedron>& tetrahedra) {
    std::vector<Side> sides;
    sides.reserve(4 * tetrahedra.size());
    for (std::uint32_t t = 0; t < tetrahedra.size(); ++t) {
        for (std::size_t without = 0; without < 4; ++without) {
            Side side{{}, t, without % 2 == 0 ? 1 : -1};
            std::copy_n(tetrahedra[t].begin(), without, side.corners.begin());
            std::copy(tetrahedra[t].begin() + static_cast<std::ptrdiff_t>(without) + 1,
                      tetrahedra[t].end(),
                      side.corners.begin() + static_cast<std::ptrdiff_t>(without));
            side.sign = sort_corners(side.corners) ? -side.sign : side.sign;
            sides.push_back(side);
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return a.corners != b.corners ? a.corners < b.corners : a.tetrahedron < b.tetrahedron;
    });
    return sides;
}

// Calls visit(first, count) for all sides on each triangle.
template <typename Visit>
void for_each_triangle(const std::vector<Side>& sides, const Visit& visit) {
    for_each_equal_run(
        sides, [](const Side& a, const Side& b) { return a.corners == b.corners; }, visit);
}

// The triangles that more tetrahedra see from one side than from the other; `sign` is by how many,
// and from which side.
std::vector<Side> rim_of(const std::vector<Tetrahedron>& tetrahedra) {
    const std::vector<Side> sides = sides_of(tetrahedra);
    std::vector<Side> rim;
    for_each_triangle(sides, [&](std::size_t first, std::size_t count) {
        int sum = 0;
        for (std::size_t i = first; i < first + count; ++i) {
            sum += sides[i].sign;
        }
        if (sum != 0) {
            Side side = sides[first];
            side.sign = sum;
            rim.push_back(side);
        }
    });
    return rim;
}

// One tetrahedron for all that are on the same corners.
struct Distinct {
    std::vector<Tetrahedron> balanced;       // facing as most of them do; none if they cancel
    std::vector<Tetrahedron> first_of_each;  // facing as the first one does
};

void add_facing(Tetrahedron corners, int sign, std::vector<Tetrahedron>& tetrahedra) {
    if (sign < 0) {
        std::swap(corners[2], corners[3]);
    }
    if (sign != 0) {
        tetrahedra.push_back(corners);
    }
}

Distinct distinct_tetrahedra(const exchange::TetSurface& surface, BoundaryReport& report) {
    struct Copies {
        int sum = 0;
        int first = 0;
    };
    std::map<Tetrahedron, Copies> all;
    for (Eigen::Index t = 0; t < surface.tetrahedra.cols(); ++t) {
        Tetrahedron corners{};
        for (int i = 0; i < 4; ++i) {
            corners[static_cast<std::size_t>(i)] = surface.tetrahedra(i, t);
        }
        const int sign = sort_corners(corners) ? -1 : 1;
        const auto [found, is_new] = all.try_emplace(corners, Copies{0, sign});
        found->second.sum += sign;
        report.repeated += is_new ? 0 : 1;
    }
    Distinct distinct;
    for (const auto& [corners, copies] : all) {
        add_facing(corners, copies.sum, distinct.balanced);
        add_facing(corners, copies.first, distinct.first_of_each);
    }
    return distinct;
}

double hypervolume_below(const Positions<4>& points,
                         const Tetrahedron& tetrahedron,
                         const Vector4d& from) {
    Eigen::Matrix4d corners;
    for (int i = 0; i < 4; ++i) {
        corners.col(i) = points.col(tetrahedron[static_cast<std::size_t>(i)]) - from;
    }
    return corners.determinant();
}

// Of three dimensions, m^3.
double volume_of(const Positions<4>& points, const Tetrahedron& tetrahedron) {
    Eigen::Matrix4d corners;
    for (int i = 0; i < 4; ++i) {
        corners.col(i) = points.col(tetrahedron[static_cast<std::size_t>(i)]);
    }
    return facet_normal<4>(corners).norm() / 6;
}

// Turns tetrahedra over until neighbors agree across triangles of two, and each such part is
// outward as seen from its middle. Returns how many.
std::int64_t make_agree(const Positions<4>& points, std::vector<Tetrahedron>& tetrahedra) {
    struct Neighbor {
        std::uint32_t tetrahedron = 0;
        bool disagrees = false;
    };
    std::vector<std::vector<Neighbor>> neighbors(tetrahedra.size());
    const std::vector<Side> sides = sides_of(tetrahedra);
    for_each_triangle(sides, [&](std::size_t first, std::size_t count) {
        if (count == 2) {
            const Side& a = sides[first];
            const Side& b = sides[first + 1];
            neighbors[a.tetrahedron].push_back({b.tetrahedron, a.sign == b.sign});
            neighbors[b.tetrahedron].push_back({a.tetrahedron, a.sign == b.sign});
        }
    });
    std::int64_t turned = 0;
    std::vector<bool> is_known(tetrahedra.size(), false);
    std::vector<bool> is_turned(tetrahedra.size(), false);
    for (std::uint32_t seed = 0; seed < tetrahedra.size(); ++seed) {
        if (is_known[seed]) {
            continue;
        }
        std::vector<std::uint32_t> part = {seed};
        is_known[seed] = true;
        Vector4d middle = Vector4d::Zero();
        for (std::size_t i = 0; i < part.size(); ++i) {
            for (const std::uint32_t corner : tetrahedra[part[i]]) {
                middle += points.col(corner) / 4;
            }
            for (const Neighbor& next : neighbors[part[i]]) {
                if (!is_known[next.tetrahedron]) {
                    is_known[next.tetrahedron] = true;
                    is_turned[next.tetrahedron] = is_turned[part[i]] != next.disagrees;
                    part.push_back(next.tetrahedron);
                }
            }
        }
        middle /= static_cast<double>(part.size());
        double hypervolume = 0;
        for (const std::uint32_t t : part) {
            const double own = hypervolume_below(points, tetrahedra[t], middle);
            hypervolume += is_turned[t] ? -own : own;
        }
        for (const std::uint32_t t : part) {
            if (is_turned[t] != (hypervolume < 0)) {
                std::swap(tetrahedra[t][2], tetrahedra[t][3]);
                ++turned;
            }
        }
    }
    return turned;
}

// The rim in parts that hang together by their points.
std::vector<std::vector<Side>> parts_of(const std::vector<Side>& rim, std::size_t points) {
    UnionFind joined(points);
    for (const Side& side : rim) {
        joined.join(side.corners[0], side.corners[1]);
        joined.join(side.corners[0], side.corners[2]);
    }
    std::map<std::uint32_t, std::vector<Side>> parts;
    for (const Side& side : rim) {
        parts[joined.find(side.corners[0])].push_back(side);
    }
    std::vector<std::vector<Side>> result;
    for (auto& [name, part] : parts) {
        result.push_back(std::move(part));
    }
    return result;
}

// Adds cones over the rim, so that none is left.
void close_holes(Positions<4>& points,
                 std::vector<Tetrahedron>& tetrahedra,
                 const std::vector<Side>& rim,
                 BoundaryReport& report) {
    const std::vector<std::vector<Side>> holes =
        parts_of(rim, static_cast<std::size_t>(points.cols()));
    auto tip = static_cast<std::uint32_t>(points.cols());
    points.conservativeResize(4, points.cols() + static_cast<Eigen::Index>(holes.size()));
    for (const std::vector<Side>& hole : holes) {
        Vector4d middle = Vector4d::Zero();
        for (const Side& side : hole) {
            for (const std::uint32_t corner : side.corners) {
                middle += points.col(corner) / (3.0 * static_cast<double>(hole.size()));
            }
        }
        points.col(tip) = middle;
        double volume = 0;
        for (const Side& side : hole) {
            // The base has the sign 1 in the boundary of the cone, which has to cancel the rim.
            Tetrahedron cone = {tip, side.corners[0], side.corners[1], side.corners[2]};
            if (side.sign > 0) {
                std::swap(cone[2], cone[3]);
            }
            tetrahedra.insert(tetrahedra.end(), static_cast<std::size_t>(std::abs(side.sign)),
                              cone);
            volume += volume_of(points, cone);
        }
        if (volume > report.largest_hole) {
            report.largest_hole = volume;
            report.hole_place = middle;
        }
        ++tip;
    }
    report.open = static_cast<std::int64_t>(rim.size());
    report.holes = static_cast<std::int64_t>(holes.size());
}

void check_holes(const std::string& name, double volume, const BoundaryReport& report) {
    if (report.largest_hole > kLargestHole * volume) {
        const Vector4d& p = report.hole_place;
        throw Error(name
                    + formatted(": a hole around (%g, %g, %g, %g) is open that %g m^3 would close, "
                                "in a boundary of %g m^3; expected one that is closed but for less "
                                "than a quarter",
                                p[0], p[1], p[2], p[3], report.largest_hole, volume));
    }
}

}  // namespace

exchange::TetSurface closed_boundary(const exchange::TetSurface& surface,
                                     const std::string& name,
                                     BoundaryReport& report) {
    report.tetrahedra = surface.tetrahedra.cols();
    const exchange::WeldedSurface welded = exchange::weld(surface);
    report.merged_points = welded.merged_points;
    report.degenerate = welded.degenerate;
    Distinct distinct = distinct_tetrahedra(welded.surface, report);
    if (distinct.first_of_each.empty()) {
        throw Error(name + ": no tetrahedron of four different points; expected a boundary");
    }
    require_usual_size<4>(welded.surface.points, name + ": the boundary");
    exchange::TetSurface closed{welded.surface.points, {}};
    std::vector<Tetrahedron>& tetrahedra = distinct.balanced;
    if (tetrahedra.empty() || !rim_of(tetrahedra).empty()) {
        tetrahedra = std::move(distinct.first_of_each);
        report.turned = make_agree(closed.points, tetrahedra);
        double volume = 0;
        for (const Tetrahedron& tetrahedron : tetrahedra) {
            volume += volume_of(closed.points, tetrahedron);
        }
        const std::vector<Side> rim = rim_of(tetrahedra);
        close_holes(closed.points, tetrahedra, rim, report);
        check_holes(name, volume, report);
    }
    closed.tetrahedra.resize(4, static_cast<Eigen::Index>(tetrahedra.size()));
    for (std::size_t t = 0; t < tetrahedra.size(); ++t) {
        for (std::size_t i = 0; i < 4; ++i) {
            closed.tetrahedra(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(t)) =
                tetrahedra[t][i];
        }
    }
    return closed;
}

}  // namespace pent::mesher
