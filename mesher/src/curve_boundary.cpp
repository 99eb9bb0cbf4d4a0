#include <pent/error.h>
#include <pent/facets.h>
#include <pent/formatted.h>
#include <pent/mesher/curve_boundary.h>
#include <pent/mesher/subdivide.h>

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

namespace pent::mesher {

namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

// Of an edge: as far from the surface may ends be, and middles in the end. Boundary vertices of
// stuffed solids are on it to 1e-6.
constexpr double kOnSurface = 1e-5;
constexpr double kFarthest = 0.25;  // at which a middle would fold its cell anyhow
constexpr int kIterations = 20;

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
// the points where it is evaluated. With barycentric coordinates l it is that of the simplex with
// the corners (4 l_a - 1) x_a + 4 sum over b != a of l_b x_ab.
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

template <int Dim>
bool is_whole(const SimplexMesh<Dim>& straight,
              const SimplexMesh<Dim>& quadratic,
              const std::map<Edge, std::uint32_t>& middles,
              Eigen::Index cell) {
    constexpr Eigen::Index kChildren = Eigen::Index{1} << Dim;
    for (Eigen::Index child = 0; child < kChildren; ++child) {
        if (!(cell_volume<Dim>(quadratic.positions, quadratic.cells, cell * kChildren + child)
              > 0)) {
            return false;
        }
    }
    Eigen::Matrix<std::uint32_t, Dim + 1, Dim + 1> nodes;
    for (int a = 0; a <= Dim; ++a) {
        for (int b = 0; b <= Dim; ++b) {
            const Edge edge = std::minmax(straight.cells(a, cell), straight.cells(b, cell));
            nodes(a, b) = a == b ? edge.first : middles.at(edge);
        }
    }
    return least_jacobian<Dim>(quadratic.positions, nodes) > 0;
}

template <int Dim>
void check_whole(const SimplexMesh<Dim>& straight,
                 const SimplexMesh<Dim>& quadratic,
                 const std::map<Edge, std::uint32_t>& middles) {
    std::int64_t folded = 0;
    Eigen::Index first = 0;
    for (Eigen::Index cell = straight.cell_count(); cell-- > 0;) {
        if (!is_whole<Dim>(straight, quadratic, middles, cell)) {
            ++folded;
            first = cell;
        }
    }
    if (folded > 0) {
        std::string place;
        for (int axis = 0; axis < Dim; ++axis) {
            place += (axis == 0 ? "" : ", ")
                     + formatted("%.4g", straight.positions(axis, straight.cells(0, first)));
        }
        throw Error(std::to_string(folded) + " of " + std::to_string(straight.cell_count())
                    + " quadratic cells would be folded with the middles of their edges on the"
                      " surface, the first at ("
                    + place + ") m; take shorter edges, or leave the boundary straight");
    }
}

// By Newton's method, the shortest step at a time, to zeros of all of these pieces at once.
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
    const std::map<Edge, std::uint32_t> middles = middles_of<Dim>(straight);
    SimplexMesh<Dim> curved = quadratic;
    CurveReport report;
    std::vector<bool> is_done(static_cast<std::size_t>(quadratic.vertex_count()), false);
    const FacetMatch<Dim> facets =
        match_facets<Dim>(straight.cells, static_cast<Eigen::Index>(straight.vertex_count()));
    for (Eigen::Index facet = 0; facet < facets.boundary.cols(); ++facet) {
        for (int a = 0; a < Dim; ++a) {
            for (int b = a + 1; b < Dim; ++b) {
                const Edge edge = std::minmax(facets.boundary(a, facet), facets.boundary(b, facet));
                const std::uint32_t middle = middles.at(edge);
                if (is_done[middle]) {
                    continue;
                }
                is_done[middle] = true;
                const Eigen::Matrix<double, Dim, 1> from = straight.positions.col(edge.first);
                const Eigen::Matrix<double, Dim, 1> to = straight.positions.col(edge.second);
                const Eigen::Matrix<double, Dim, 1> place = onto(from, to);
                const double distance = (place - curved.positions.col(middle)).norm();
                if (distance > 1e-9 * (to - from).norm()) {
                    curved.positions.col(middle) = place;
                    ++report.moved;
                    report.farthest = std::max(report.farthest, distance);
                }
            }
        }
    }
    check_whole<Dim>(straight, curved, middles);
    quadratic = std::move(curved);
    return report;
}

template CurveReport curve_boundary<3>(const SimplexMesh<3>&,
                                       const OntoSurface<3>&,
                                       SimplexMesh<3>&);
template CurveReport curve_boundary<4>(const SimplexMesh<4>&,
                                       const OntoSurface<4>&,
                                       SimplexMesh<4>&);

}  // namespace pent::mesher
