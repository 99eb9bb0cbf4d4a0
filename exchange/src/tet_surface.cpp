#include <pent/equal_runs.h>
#include <pent/error.h>
#include <pent/exchange/tet_surface.h>
#include <pent/facets.h>
#include <pent/geometry.h>

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace pent::exchange {

namespace {

using Eigen::Vector4d;

// For each point the first one at the same place.
std::vector<std::uint32_t> first_at_same_place(const Positions<4>& points) {
    std::vector<std::uint32_t> order(static_cast<std::size_t>(points.cols()));
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const auto p = points.col(a);
        const auto q = points.col(b);
        return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
    });
    std::vector<std::uint32_t> first(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool is_same = i > 0 && points.col(order[i]) == points.col(order[i - 1]);
        first[order[i]] = is_same ? first[order[i - 1]] : order[i];
    }
    return first;
}

bool has_corner_twice(const Eigen::Vector<std::uint32_t, 4>& corners) {
    for (int a = 0; a < 4; ++a) {
        for (int b = a + 1; b < 4; ++b) {
            if (corners[a] == corners[b]) {
                return true;
            }
        }
    }
    return false;
}

// The points that some tetrahedra use, in their order, and the tetrahedra by indices of these.
struct UsedPoints {
    std::vector<std::uint32_t> points;
    Simplices<4> tetrahedra;
};

UsedPoints used_points_of(const Simplices<4>& tetrahedra, Eigen::Index points) {
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> new_index(static_cast<std::size_t>(points), kNone);
    for (const std::uint32_t corner : tetrahedra.reshaped()) {
        new_index[corner] = 0;
    }
    UsedPoints used;
    for (std::size_t point = 0; point < new_index.size(); ++point) {
        if (new_index[point] != kNone) {
            new_index[point] = static_cast<std::uint32_t>(used.points.size());
            used.points.push_back(static_cast<std::uint32_t>(point));
        }
    }
    used.tetrahedra = tetrahedra.unaryExpr([&](std::uint32_t corner) { return new_index[corner]; });
    return used;
}

// A triangle of a tetrahedron: its corners increasing, and whether the orientation that the
// tetrahedron induces on it is the opposite of that order.
struct Side {
    std::array<std::uint32_t, 3> corners{};
    std::uint32_t tetrahedron = 0;
    bool is_turned = false;

    bool operator<(const Side& other) const { return corners < other.corners; }
};

// All triangles, those with the same corners side by side.
std::vector<Side> sides_of(const Simplices<4>& tetrahedra) {
    std::vector<Side> sides;
    sides.reserve(static_cast<std::size_t>(4 * tetrahedra.cols()));
    for (Eigen::Index t = 0; t < tetrahedra.cols(); ++t) {
        for (int without = 0; without < 4; ++without) {
            Side side{.tetrahedron = static_cast<std::uint32_t>(t), .is_turned = without % 2 == 1};
            for (int corner = 0, at = 0; corner < 4; ++corner) {
                if (corner != without) {
                    side.corners[static_cast<std::size_t>(at++)] = tetrahedra(corner, t);
                }
            }
            // Each exchange of neighbors turns the triangle over.
            auto& c = side.corners;
            for (const std::size_t low : {0U, 1U, 0U}) {
                if (c[low] > c[low + 1]) {
                    std::swap(c[low], c[low + 1]);
                    side.is_turned = !side.is_turned;
                }
            }
            sides.push_back(side);
        }
    }
    std::sort(sides.begin(), sides.end());
    return sides;
}

// Calls back with the first side of each triangle and how many there are.
template <typename Visit>
void for_each_triangle(const std::vector<Side>& sides, const Visit& visit) {
    for_each_equal_run(
        sides, [](const Side& a, const Side& b) { return a.corners == b.corners; }, visit);
}

// What a tetrahedron spans with the surface's first point; over a closed surface these sum to what
// it encloses. With the origin they would, too, but cancel all digits of a surface far from it.
double hypervolume_below(const TetSurface& surface, Eigen::Index tetrahedron) {
    Eigen::Matrix4d corners;
    for (int corner = 0; corner < 4; ++corner) {
        corners.col(corner) =
            surface.points.col(surface.tetrahedra(corner, tetrahedron)) - surface.points.col(0);
    }
    return corners.determinant() / 24;
}

void turn_over(TetSurface& surface, Eigen::Index tetrahedron) {
    std::swap(surface.tetrahedra(2, tetrahedron), surface.tetrahedra(3, tetrahedron));
}

// The pieces of a closed surface, and which of their tetrahedra to turn over so that neighbors
// agree with the first one of each.
class Pieces {
public:
    Pieces(const std::vector<Side>& sides, std::size_t tetrahedra)
        : piece_(tetrahedra, kNone), is_turned_(tetrahedra, false) {
        std::vector<std::array<Neighbor, 4>> neighbors(tetrahedra);
        std::vector<std::uint8_t> known(tetrahedra, 0);
        for_each_triangle(sides, [&](std::size_t at, std::size_t /*count*/) {
            const Side& a = sides[at];
            const Side& b = sides[at + 1];
            const bool disagrees = a.is_turned == b.is_turned;
            neighbors[a.tetrahedron][known[a.tetrahedron]++] = {b.tetrahedron, disagrees};
            neighbors[b.tetrahedron][known[b.tetrahedron]++] = {a.tetrahedron, disagrees};
        });
        for (std::uint32_t seed = 0; seed < tetrahedra; ++seed) {
            if (piece_[seed] == kNone) {
                collect(seed, neighbors);
            }
        }
    }

    [[nodiscard]] std::uint32_t count() const { return count_; }
    [[nodiscard]] std::uint32_t of(std::size_t tetrahedron) const { return piece_[tetrahedron]; }
    [[nodiscard]] bool is_turned(std::size_t tetrahedron) const { return is_turned_[tetrahedron]; }
    [[nodiscard]] bool is_orientable() const { return is_orientable_; }

private:
    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    struct Neighbor {
        std::uint32_t tetrahedron = 0;
        bool disagrees = false;
    };

    void collect(std::uint32_t seed, const std::vector<std::array<Neighbor, 4>>& neighbors) {
        std::vector<std::uint32_t> front = {seed};
        piece_[seed] = count_;
        while (!front.empty()) {
            const std::uint32_t now = front.back();
            front.pop_back();
            for (const Neighbor& next : neighbors[now]) {
                const bool is_turned = is_turned_[now] != next.disagrees;
                if (piece_[next.tetrahedron] == kNone) {
                    piece_[next.tetrahedron] = count_;
                    is_turned_[next.tetrahedron] = is_turned;
                    front.push_back(next.tetrahedron);
                } else if (is_turned_[next.tetrahedron] != is_turned) {
                    is_orientable_ = false;
                }
            }
        }
        ++count_;
    }

    std::vector<std::uint32_t> piece_;
    std::vector<bool> is_turned_;
    std::uint32_t count_ = 0;
    bool is_orientable_ = true;
};

// The half-spaces behind the tetrahedra: a point in all of them (in the kernel of the body) sees
// the whole surface from inside.
struct HalfSpaces {
    Positions<4> normals;  // outward, of unit length
    Eigen::VectorXd offsets;

    // How deep a point is in the half-space in which it is least deep; negative outside of one.
    [[nodiscard]] double depth(const Vector4d& x, Eigen::Index& nearest) const {
        return (offsets - normals.transpose() * x).minCoeff(&nearest);
    }
};

HalfSpaces half_spaces_of(const TetSurface& surface) {
    HalfSpaces spaces{Positions<4>(4, surface.tetrahedra.cols()),
                      Eigen::VectorXd(surface.tetrahedra.cols())};
    for (Eigen::Index t = 0; t < surface.tetrahedra.cols(); ++t) {
        Eigen::Matrix4d corners;
        for (int k = 0; k < 4; ++k) {
            corners.col(k) = surface.points.col(surface.tetrahedra(k, t));
        }
        const Vector4d normal = facet_normal<4>(corners);
        const double length = normal.norm();
        spaces.normals.col(t) = length > 0 ? Vector4d(normal / length) : Vector4d::Zero();
        spaces.offsets[t] = length > 0 ? spaces.normals.col(t).dot(corners.col(0)) : 1;
    }
    return spaces;
}

// A point inside of all half-spaces by at least `margin`, by steps beyond the worst one (Agmon,
// Motzkin and Schoenberg's relaxation); false if there is none or it was not found.
bool move_inside(const HalfSpaces& spaces, double margin, Vector4d& x) {
    constexpr int kMaxSteps = 2000;
    constexpr double kOvershoot = 1.5;
    for (int step = 0; step < kMaxSteps; ++step) {
        Eigen::Index worst = 0;
        const double depth = spaces.depth(x, worst);
        if (depth >= margin) {
            return true;
        }
        x -= kOvershoot * (margin - depth) * spaces.normals.col(worst);
    }
    return false;
}

}  // namespace

WeldedSurface weld(const TetSurface& surface) {
    const std::vector<std::uint32_t> first = first_at_same_place(surface.points);
    WeldedSurface welded{surface};
    for (std::size_t point = 0; point < first.size(); ++point) {
        welded.merged_points += first[point] != point ? 1 : 0;
    }
    Simplices<4>& tetrahedra = welded.surface.tetrahedra;
    Eigen::Index kept = 0;
    for (Eigen::Index t = 0; t < tetrahedra.cols(); ++t) {
        const Eigen::Vector<std::uint32_t, 4> corners =
            tetrahedra.col(t).unaryExpr([&](std::uint32_t corner) { return first[corner]; });
        if (has_corner_twice(corners)) {
            ++welded.degenerate;
        } else {
            tetrahedra.col(kept++) = corners;
        }
    }
    tetrahedra.conservativeResize(4, kept);
    welded.surface = without_unused_points(welded.surface);
    return welded;
}

TetSurface without_unused_points(const TetSurface& surface) {
    UsedPoints used = used_points_of(surface.tetrahedra, surface.points.cols());
    return {surface.points(Eigen::all, used.points), std::move(used.tetrahedra)};
}

SurfaceCheck check(const TetSurface& surface) {
    const std::vector<Side> sides = sides_of(surface.tetrahedra);
    SurfaceCheck check;
    for_each_triangle(sides, [&](std::size_t at, std::size_t count) {
        check.open += count == 1 ? 1 : 0;
        check.overfull += count > 2 ? 1 : 0;
        check.one_sided += count == 2 && sides[at].is_turned == sides[at + 1].is_turned ? 1 : 0;
    });
    return check;
}

double enclosed_hypervolume(const TetSurface& surface) {
    double sum = 0;
    for (Eigen::Index t = 0; t < surface.tetrahedra.cols(); ++t) {
        sum += hypervolume_below(surface, t);
    }
    return sum;
}

void orient(TetSurface& surface, std::string_view name) {
    const SurfaceCheck found = check(surface);
    if (!found.is_closed()) {
        return;
    }
    const auto count = static_cast<std::size_t>(surface.tetrahedra.cols());
    if (found.one_sided == 0) {
        if (enclosed_hypervolume(surface) < 0) {
            for (std::size_t t = 0; t < count; ++t) {
                turn_over(surface, static_cast<Eigen::Index>(t));
            }
        }
        return;
    }
    const Pieces pieces(sides_of(surface.tetrahedra), count);
    if (!pieces.is_orientable()) {
        throw Error(std::string(name)
                    + ": a piece of it has one side only, as a Klein bottle has, and encloses"
                      " nothing");
    }
    std::vector<double> hypervolumes(pieces.count(), 0);
    for (std::size_t t = 0; t < count; ++t) {
        if (pieces.is_turned(t)) {
            turn_over(surface, static_cast<Eigen::Index>(t));
        }
        hypervolumes[pieces.of(t)] += hypervolume_below(surface, static_cast<Eigen::Index>(t));
    }
    for (std::size_t t = 0; t < count; ++t) {
        if (hypervolumes[pieces.of(t)] < 0) {
            turn_over(surface, static_cast<Eigen::Index>(t));
        }
    }
}

TetSurface boundary_of(const SimplexMesh<4>& mesh) {
    return boundary_with_vertices(mesh).surface;
}

BodyBoundary boundary_with_vertices(const SimplexMesh<4>& mesh) {
    const FacetMatch<4> match = match_facets<4>(mesh.cells, mesh.vertex_count());
    UsedPoints used = used_points_of(match.boundary, mesh.vertex_count());
    return {{mesh.positions(Eigen::all, used.points), std::move(used.tetrahedra)},
            std::move(used.points)};
}

SimplexMesh<4> cone_of(const TetSurface& surface, std::string_view name) {
    const SurfaceCheck found = check(surface);
    if (!found.is_oriented()) {
        throw Error(std::string(name) + ": is no closed surface: "
                    + std::to_string(found.open + found.overfull + found.one_sided)
                    + " triangles without a neighbor of their own; a body has none");
    }
    // About one of its points, so that a surface far from the origin keeps all digits.
    const Vector4d about = surface.points.col(0);
    const TetSurface near{surface.points.colwise() - about, surface.tetrahedra};
    const HalfSpaces spaces = half_spaces_of(near);
    const double size =
        (near.points.rowwise().maxCoeff() - near.points.rowwise().minCoeff()).norm();
    Vector4d center = near.points.rowwise().mean();
    if (!move_inside(spaces, 1e-6 * size, center)) {
        throw Error(std::string(name)
                    + ": no point was found that sees all of the surface; a body is made of what is"
                      " convex or shaped as a star alone");
    }
    // As deep as can be had, for the shape of the pentachora.
    for (double margin = 2e-6 * size; margin < size; margin *= 1.5) {
        Vector4d deeper = center;
        if (!move_inside(spaces, margin, deeper)) {
            break;
        }
        center = deeper;
    }
    SimplexMesh<4> mesh;
    mesh.positions.resize(4, surface.points.cols() + 1);
    mesh.positions << surface.points, about + center;
    mesh.cells.resize(5, surface.tetrahedra.cols());
    mesh.cells.row(0).setConstant(static_cast<std::uint32_t>(surface.points.cols()));
    mesh.cells.bottomRows<4>() = surface.tetrahedra;
    return mesh;
}

}  // namespace pent::exchange
