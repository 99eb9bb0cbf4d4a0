#include <pent/facets.h>
#include <pent/mesher/curve_boundary.h>
#include <pent/mesher/subdivide.h>

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

namespace pent::mesher {

namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

// How far from the surface the ends of an edge may be, and its midpoint after the move, in parts of
// the edge. Boundary vertices of stuffed solids are on the surface to 1e-6.
constexpr double kOnSurface = 1e-5;
constexpr double kFarthest = 0.25;  // of the edge: a longer way would fold the cell in any case
constexpr int kIterations = 20;

// How often the way of a midpoint is halved before it is left on its edge.
constexpr int kMaxHalvings = 4;

// All middles of a quadratic mesh by their edges, lower vertex first.
template <int Dim>
std::map<Edge, std::uint32_t> middles_of(const SimplexMesh<Dim>& straight) {
    std::map<Edge, std::uint32_t> middles;
    auto next = static_cast<std::uint32_t>(straight.vertex_count());
    for (const auto& [a, b] : cut_edges<Dim>(straight)) {
        middles[std::minmax(a, b)] = next++;
    }
    return middles;
}

// The least Jacobian of a quadratic cell, over Dim!: of its straight simplex, at its nodes and at
// its integration points. At barycentric coordinates l it is the volume of the simplex with the
// corners (4 l_a - 1) x_a + 4 sum over b != a of l_b x_ab: the derivatives of the shape functions.
template <int Dim>
double least_jacobian(const Positions<Dim>& positions,
                      const Eigen::Matrix<std::uint32_t, Dim + 1, Dim + 1>& nodes) {
    using Coordinates = Eigen::Matrix<double, Dim + 1, 1>;
    const auto volume_at = [&](const Coordinates& l) {
        Eigen::Matrix<double, Dim, Dim + 1> corners;
        for (int a = 0; a <= Dim; ++a) {
            corners.col(a) = -positions.col(nodes(a, a));
            for (int b = 0; b <= Dim; ++b) {
                corners.col(a) += 4 * l[b] * positions.col(nodes(a, b));
            }
        }
        return simplex_volume<Dim>(corners);
    };
    Eigen::Matrix<double, Dim, Dim + 1> straight;
    for (int a = 0; a <= Dim; ++a) {
        straight.col(a) = positions.col(nodes(a, a));
    }
    const double far = (Dim + 2 - std::sqrt(Dim + 2.0)) / ((Dim + 1) * (Dim + 2));
    double least = simplex_volume<Dim>(straight);
    for (int a = 0; a <= Dim; ++a) {
        Coordinates point = Coordinates::Constant(far);
        point[a] = 1 - Dim * far;
        least = std::min(least, volume_at(point));
        for (int b = a; b <= Dim; ++b) {
            Coordinates node = Coordinates::Zero();
            node[a] += 0.5;
            node[b] += 0.5;
            least = std::min(least, volume_at(node));
        }
    }
    return least;
}

// The middles of a mesh's edges, and how far of their ways to the surface they have gone.
template <int Dim>
class Curving {
public:
    using Vector = Eigen::Matrix<double, Dim, 1>;

    Curving(const SimplexMesh<Dim>& straight, const SimplexMesh<Dim>& quadratic)
        : straight_(straight),
          curved_(quadratic),
          middles_(middles_of<Dim>(straight)),
          ways_(Positions<Dim>::Zero(Dim, quadratic.vertex_count())),
          halvings_(static_cast<std::size_t>(quadratic.vertex_count()), 0) {}

    void move_onto(const OntoSurface<Dim>& onto) {
        const FacetMatch<Dim> facets = match_facets<Dim>(straight_.cells, straight_.vertex_count());
        std::set<Edge> edges;
        for (Eigen::Index facet = 0; facet < facets.boundary.cols(); ++facet) {
            for (int a = 0; a < Dim; ++a) {
                for (int b = a + 1; b < Dim; ++b) {
                    edges.insert(std::minmax(facets.boundary(a, facet), facets.boundary(b, facet)));
                }
            }
        }
        for (const Edge& edge : edges) {
            move_middle(edge, onto);
        }
    }

    // Halves the ways of the midpoints of folded cells until no cell is folded. That ends: after
    // kMaxHalvings a midpoint is back on its edge, and a cell with all of them there is straight.
    void unfold() {
        std::vector<Eigen::Index> suspects(static_cast<std::size_t>(straight_.cell_count()));
        std::iota(suspects.begin(), suspects.end(), Eigen::Index{0});
        while (!suspects.empty()) {
            std::vector<bool> is_halved(halvings_.size(), false);
            for (const Eigen::Index cell : suspects) {
                if (!is_whole(cell)) {
                    halve_ways(cell, is_halved);
                }
            }
            suspects.clear();
            for (Eigen::Index cell = 0; cell < straight_.cell_count(); ++cell) {
                const auto nodes = nodes_of(cell);
                if (std::any_of(nodes.data(), nodes.data() + nodes.size(),
                                [&](std::uint32_t node) { return is_halved[node]; })) {
                    suspects.push_back(cell);
                }
            }
        }
    }

    [[nodiscard]] CurveReport report() const {
        CurveReport report;
        for (Eigen::Index v = 0; v < curved_.vertex_count(); ++v) {
            const int halvings = halvings_[static_cast<std::size_t>(v)];
            const double distance = part_left(halvings) * ways_.col(v).norm();
            report.moved += distance > 0 ? 1 : 0;
            report.limited += halvings > 0 ? 1 : 0;
            report.farthest = std::max(report.farthest, distance);
        }
        return report;
    }

    [[nodiscard]] const SimplexMesh<Dim>& curved() const { return curved_; }

private:
    using Nodes = Eigen::Matrix<std::uint32_t, Dim + 1, Dim + 1>;

    static double part_left(int halvings) {
        return halvings < kMaxHalvings ? std::ldexp(1.0, -halvings) : 0;
    }

    void move_middle(const Edge& edge, const OntoSurface<Dim>& onto) {
        const std::uint32_t middle = middles_.at(edge);
        const Vector from = straight_.positions.col(edge.first);
        const Vector to = straight_.positions.col(edge.second);
        const Vector way = onto(from, to) - curved_.positions.col(middle);
        if (way.norm() > kOnSurface * (to - from).norm()) {
            ways_.col(middle) = way;
            curved_.positions.col(middle) += way;
        }
    }

    // The node between each two corners; the corners themselves on the diagonal.
    [[nodiscard]] Nodes nodes_of(Eigen::Index cell) const {
        Nodes nodes;
        for (int a = 0; a <= Dim; ++a) {
            for (int b = 0; b <= Dim; ++b) {
                const Edge edge = std::minmax(straight_.cells(a, cell), straight_.cells(b, cell));
                nodes(a, b) = a == b ? edge.first : middles_.at(edge);
            }
        }
        return nodes;
    }

    [[nodiscard]] bool is_whole(Eigen::Index cell) const {
        constexpr Eigen::Index kChildren = Eigen::Index{1} << Dim;
        for (Eigen::Index child = cell * kChildren; child < (cell + 1) * kChildren; ++child) {
            if (!(cell_volume<Dim>(curved_.positions, curved_.cells, child) > 0)) {
                return false;
            }
        }
        return least_jacobian<Dim>(curved_.positions, nodes_of(cell)) > 0;
    }

    void halve_ways(Eigen::Index cell, std::vector<bool>& is_halved) {
        const Nodes nodes = nodes_of(cell);
        for (int a = 0; a <= Dim; ++a) {
            for (int b = a + 1; b <= Dim; ++b) {
                const std::uint32_t node = nodes(a, b);
                int& halvings = halvings_[node];
                if (is_halved[node] || halvings == kMaxHalvings || !ways_.col(node).any()) {
                    continue;
                }
                const double before = part_left(halvings);
                ++halvings;
                curved_.positions.col(node) += (part_left(halvings) - before) * ways_.col(node);
                is_halved[node] = true;
            }
        }
    }

    const SimplexMesh<Dim>& straight_;
    SimplexMesh<Dim> curved_;
    std::map<Edge, std::uint32_t> middles_;
    Positions<Dim> ways_;  // of all vertices, onto the surface; 0 of those that do not move
    std::vector<int> halvings_;
};

// A point at which all of these pieces are zero, by Newton's method: there are fewer equations than
// coordinates, and each step is the shortest one that solves them.
Eigen::Vector4d onto_pieces(const Solid& solid,
                            const std::vector<int>& pieces,
                            const Eigen::Vector4d& from,
                            double edge) {
    const double h = 1e-4 * edge;  // of central differences
    const auto count = static_cast<Eigen::Index>(pieces.size());
    Eigen::Vector4d x = from;
    for (int iteration = 0; iteration < kIterations; ++iteration) {
        Eigen::VectorXd values(count);
        Eigen::MatrixXd slopes(count, 4);
        for (Eigen::Index i = 0; i < count; ++i) {
            const int piece = pieces[static_cast<std::size_t>(i)];
            values[i] = solid.piece_value(piece, x);
            for (int axis = 0; axis < 4; ++axis) {
                const Eigen::Vector4d step = h * Eigen::Vector4d::Unit(axis);
                slopes(i, axis) =
                    (solid.piece_value(piece, x + step) - solid.piece_value(piece, x - step))
                    / (2 * h);
            }
        }
        const Eigen::Vector4d step = -slopes.completeOrthogonalDecomposition().solve(values);
        x += step;
        if (!(step.norm() > 1e-9 * edge)) {
            break;
        }
    }
    return x;
}

}  // namespace

OntoSurface<3> onto_sphere(double radius) {
    return [radius](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
        const Eigen::Vector3d middle = (from + to) / 2;
        const double off = std::max(std::abs(from.norm() - radius), std::abs(to.norm() - radius));
        return off > kOnSurface * (to - from).norm()
                   ? middle
                   : Eigen::Vector3d(radius * middle.normalized());
    };
}

OntoSurface<4> onto_boundary(const Solid& solid) {
    return [solid](const Eigen::Vector4d& from, const Eigen::Vector4d& to) -> Eigen::Vector4d {
        const Eigen::Vector4d middle = (from + to) / 2;
        const double edge = (to - from).norm();
        std::vector<int> pieces;
        for (const int piece : solid.pieces_near(from, kOnSurface * edge)) {
            if (std::abs(solid.piece_value(piece, from)) <= kOnSurface * edge
                && std::abs(solid.piece_value(piece, to)) <= kOnSurface * edge) {
                pieces.push_back(piece);
            }
        }
        if (pieces.empty()) {
            return middle;
        }
        const Eigen::Vector4d x = onto_pieces(solid, pieces, middle, edge);
        const bool is_there = x.allFinite() && (x - middle).norm() <= kFarthest * edge
                              && std::abs(solid.value(x)) <= kOnSurface * edge;
        return is_there ? x : middle;
    };
}

template <int Dim>
CurveReport curve_boundary(const SimplexMesh<Dim>& straight,
                           const OntoSurface<Dim>& onto,
                           SimplexMesh<Dim>& quadratic) {
    Curving<Dim> curving(straight, quadratic);
    curving.move_onto(onto);
    curving.unfold();
    quadratic = curving.curved();
    return curving.report();
}

template CurveReport curve_boundary<3>(const SimplexMesh<3>&,
                                       const OntoSurface<3>&,
                                       SimplexMesh<3>&);
template CurveReport curve_boundary<4>(const SimplexMesh<4>&,
                                       const OntoSurface<4>&,
                                       SimplexMesh<4>&);

}  // namespace pent::mesher
