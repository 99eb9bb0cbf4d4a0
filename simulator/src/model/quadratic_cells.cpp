#include "model/quadratic_cells.h"

#include <pent/dimensions.h>
#include <pent/equal_runs.h>
#include <pent/error.h>
#include <pent/formatted.h>

#include <Eigen/LU>

#include <algorithm>
#include <numeric>

namespace pent::simulator {

namespace {

template <int Dim>
constexpr Eigen::Index kChildren = Eigen::Index{1} << Dim;

[[noreturn]] void refuse(const std::string& name, const std::string& found) {
    throw Error(name + ": " + found
                + ", expected cells that are the children of quadratic ones; make the mesh by"
                  " pent-mesh --quadratic, or take other elements");
}

// The corners that cells have alone, each with its cell.
template <int Dim>
struct CornerChildren {
    std::vector<std::uint32_t> corners;
    std::vector<Eigen::Index> cells;
    std::size_t vertices = 0;  // different ones of all cells
};

template <int Dim>
CornerChildren<Dim> corner_children(const SimplexMesh<Dim>& mesh, const Eigen::Index* cells) {
    std::vector<std::pair<std::uint32_t, Eigen::Index>> owned;
    for (Eigen::Index i = 0; i < kChildren<Dim>; ++i) {
        for (int a = 0; a <= Dim; ++a) {
            owned.emplace_back(mesh.cells(a, cells[i]), cells[i]);
        }
    }
    std::sort(owned.begin(), owned.end());
    CornerChildren<Dim> found;
    for_each_equal_run(
        owned, [](const auto& a, const auto& b) { return a.first == b.first; },
        [&](std::size_t first, std::size_t count) {
            ++found.vertices;
            if (count == 1) {
                found.corners.push_back(owned[first].first);
                found.cells.push_back(owned[first].second);
            }
        });
    return found;
}

// Nodes of one quadratic simplex, corners by increasing number but for orientation; false if cells
// are not its children.
template <int Dim>
bool find_nodes(const SimplexMesh<Dim>& mesh,
                const Eigen::Index* cells,
                Eigen::Matrix<std::uint32_t, kQuadraticNodes<Dim>, 1>& nodes) {
    constexpr const QuadraticRule<Dim>& kRule = kQuadraticRule<Dim>;
    CornerChildren<Dim> found = corner_children<Dim>(mesh, cells);
    if (found.corners.size() != Dim + 1 || found.vertices != kQuadraticNodes<Dim>) {
        return false;
    }
    Eigen::Matrix<double, Dim, Dim + 1> corners;
    for (int a = 0; a <= Dim; ++a) {
        corners.col(a) = mesh.positions.col(found.corners[static_cast<std::size_t>(a)]);
    }
    if (simplex_volume<Dim>(corners) < 0) {
        std::swap(found.corners[Dim - 1], found.corners[Dim]);
        std::swap(found.cells[Dim - 1], found.cells[Dim]);
    }
    std::vector<std::uint32_t> middles;
    for (int node = 0; node < kQuadraticNodes<Dim>; ++node) {
        const auto a = static_cast<std::size_t>(kRule.first[node]);
        const auto b = static_cast<std::size_t>(kRule.second[node]);
        if (a == b) {
            nodes[node] = found.corners[a];
            continue;
        }
        int shared = 0;
        const auto other = mesh.cells.col(found.cells[b]);
        for (const std::uint32_t vertex : mesh.cells.col(found.cells[a])) {
            if (std::find(other.begin(), other.end(), vertex) != other.end()) {
                nodes[node] = vertex;
                middles.push_back(vertex);
                ++shared;
            }
        }
        if (shared != 1) {
            return false;
        }
    }
    std::sort(middles.begin(), middles.end());
    return std::adjacent_find(middles.begin(), middles.end()) == middles.end();
}

template <int Dim>
Eigen::Matrix<double, Dim + 1, 1> coordinates_of(int point) {
    Eigen::Matrix<double, Dim + 1, 1> l =
        Eigen::Matrix<double, Dim + 1, 1>::Constant(QuadraticPoint<Dim>::kFar);
    l[point] = QuadraticPoint<Dim>::kNear;
    return l;
}

// At the points where it is evaluated, and at nodes, where it is least if a middle has moved far.
template <int Dim>
double least_jacobian(const Eigen::Matrix<double, Dim, kQuadraticNodes<Dim>>& places) {
    constexpr const QuadraticRule<Dim>& kRule = kQuadraticRule<Dim>;
    using Coordinates = Eigen::Matrix<double, Dim + 1, 1>;
    const auto at = [&](const Coordinates& l) {
        return simplex_volume<Dim>(tangent_corners<Dim>(places, l));
    };
    const double straight = simplex_volume<Dim>(places.template leftCols<Dim + 1>());
    double least = 1;
    for (int point = 0; point < kQuadraticPoints<Dim>; ++point) {
        least = std::min(least, at(coordinates_of<Dim>(point)) / straight);
    }
    for (int node = 0; node < kQuadraticNodes<Dim>; ++node) {
        Coordinates l = Coordinates::Zero();
        l[kRule.first[node]] += 0.5;
        l[kRule.second[node]] += 0.5;
        least = std::min(least, at(l) / straight);
    }
    return least;
}

template <int Dim>
void check_whole(const Positions<Dim>& positions,
                 const QuadraticSimplices<Dim>& simplices,
                 const std::vector<Eigen::Index>& cells,
                 const std::string& name) {
    std::int64_t folded = 0;
    Eigen::Index worst = 0;
    double least = 0;
    for (Eigen::Index simplex = 0; simplex < simplices.cols(); ++simplex) {
        const double jacobian =
            least_jacobian<Dim>(places_of_nodes<Dim>(positions, simplices, simplex));
        if (!(jacobian > 0)) {
            worst = folded == 0 || jacobian < least ? simplex : worst;
            least = folded == 0 ? jacobian : std::min(least, jacobian);
            ++folded;
        }
    }
    if (folded == 0) {
        return;
    }
    std::string place;
    for (int axis = 0; axis < Dim; ++axis) {
        place += (axis == 0 ? "" : ", ") + formatted("%.4g", positions(axis, simplices(0, worst)));
    }
    throw Error(name + ": " + std::to_string(folded) + " of " + std::to_string(simplices.cols())
                + " quadratic cells are folded at rest, the worst (a Jacobian of "
                + formatted("%.3g", least) + " of that of straight edges) that of cell "
                + std::to_string(cells[static_cast<std::size_t>(worst * kChildren<Dim>)]) + " at ("
                + place + ") m, expected none; move the middles of their edges less");
}

}  // namespace

template <int Dim>
Eigen::Matrix<double, Dim, Dim + 1> tangent_corners(
    const Eigen::Matrix<double, Dim, kQuadraticNodes<Dim>>& places,
    const Eigen::Matrix<double, Dim + 1, 1>& coordinates) {
    Eigen::Matrix<double, Dim, Dim + 1> corners;
    for (int a = 0; a <= Dim; ++a) {
        corners.col(a) = -places.col(a);
        for (int b = 0; b <= Dim; ++b) {
            corners.col(a) += 4 * coordinates[b] * places.col(kQuadraticRule<Dim>.node[a][b]);
        }
    }
    return corners;
}

template <int Dim>
Eigen::Matrix<double, Dim, kQuadraticNodes<Dim>> places_of_nodes(
    const Positions<Dim>& positions,
    const QuadraticSimplices<Dim>& simplices,
    Eigen::Index simplex) {
    Eigen::Matrix<double, Dim, kQuadraticNodes<Dim>> places;
    for (int node = 0; node < kQuadraticNodes<Dim>; ++node) {
        places.col(node) = positions.col(simplices(node, simplex));
    }
    return places;
}

template <int Dim>
QuadraticRest<Dim> quadratic_rest(const Eigen::Matrix<double, Dim, kQuadraticNodes<Dim>>& places) {
    constexpr std::size_t kRows = std::size_t{Dim} * Dim + 1;
    QuadraticRest<Dim> rest;
    for (int point = 0; point < kQuadraticPoints<Dim>; ++point) {
        const Eigen::Matrix<double, Dim, Dim + 1> corners =
            tangent_corners<Dim>(places, coordinates_of<Dim>(point));
        const Eigen::Matrix<double, Dim, Dim> Dm =
            corners.template rightCols<Dim>().colwise() - corners.col(0);
        const Eigen::Matrix<double, Dim, Dim> gradients = Dm.inverse().transpose();
        const auto first = rest.rows.begin() + static_cast<std::ptrdiff_t>(point * kRows);
        std::copy_n(gradients.data(), gradients.size(), first);
        first[kRows - 1] = simplex_volume<Dim>(corners) / kQuadraticPoints<Dim>;
        rest.volume += first[kRows - 1];
    }
    for (std::size_t row = kRows - 1; row < rest.rows.size(); row += kRows) {
        rest.rows[row] /= rest.volume;  // a share
    }
    return rest;
}

template <int Dim>
std::vector<Eigen::Index> child_cells(const SimplexMesh<Dim>& mesh, const std::string& name) {
    if (mesh.cell_count() % kChildren<Dim> != 0) {
        refuse(name, std::to_string(mesh.cell_count()) + " cells, no multiple of "
                         + std::to_string(kChildren<Dim>));
    }
    std::vector<Eigen::Index> cells(static_cast<std::size_t>(mesh.cell_count()));
    std::iota(cells.begin(), cells.end(), Eigen::Index{0});
    if (mesh.parents.empty()) {
        return cells;
    }
    const auto parent = [&](Eigen::Index cell) {
        return mesh.parents[static_cast<std::size_t>(cell)];
    };
    std::stable_sort(cells.begin(), cells.end(),
                     [&](Eigen::Index a, Eigen::Index b) { return parent(a) < parent(b); });
    for_each_equal_run(
        cells, [&](Eigen::Index a, Eigen::Index b) { return parent(a) == parent(b); },
        [&](std::size_t first, std::size_t count) {
            if (count != static_cast<std::size_t>(kChildren<Dim>)) {
                refuse(name, "parent " + std::to_string(parent(cells[first])) + " with "
                                 + std::to_string(count) + " cells");
            }
        });
    return cells;
}

template <int Dim>
QuadraticSimplices<Dim> quadratic_simplices(const SimplexMesh<Dim>& mesh,
                                            const std::vector<Eigen::Index>& cells,
                                            const std::string& name) {
    QuadraticSimplices<Dim> simplices(kQuadraticNodes<Dim>, mesh.cell_count() / kChildren<Dim>);
    for (Eigen::Index simplex = 0; simplex < simplices.cols(); ++simplex) {
        const Eigen::Index* children = cells.data() + simplex * kChildren<Dim>;
        Eigen::Matrix<std::uint32_t, kQuadraticNodes<Dim>, 1> nodes;
        if (!find_nodes<Dim>(mesh, children, nodes)) {
            refuse(name, "cell " + std::to_string(children[0]) + " and "
                             + std::to_string(kChildren<Dim> - 1)
                             + " more that do not make up one simplex with its edges cut in two");
        }
        simplices.col(simplex) = nodes;
    }
    check_whole<Dim>(mesh.positions, simplices, cells, name);
    return simplices;
}

#define PENT_INSTANTIATE(Dim)                                                       \
    template Eigen::Matrix<double, Dim, Dim + 1> tangent_corners<Dim>(              \
        const Eigen::Matrix<double, Dim, kQuadraticNodes<Dim>>&,                    \
        const Eigen::Matrix<double, Dim + 1, 1>&);                                  \
    template Eigen::Matrix<double, Dim, kQuadraticNodes<Dim>> places_of_nodes<Dim>( \
        const Positions<Dim>&, const QuadraticSimplices<Dim>&, Eigen::Index);       \
    template QuadraticRest<Dim> quadratic_rest<Dim>(                                \
        const Eigen::Matrix<double, Dim, kQuadraticNodes<Dim>>&);                   \
    template std::vector<Eigen::Index> child_cells<Dim>(const SimplexMesh<Dim>&,    \
                                                        const std::string&);        \
    template QuadraticSimplices<Dim> quadratic_simplices<Dim>(                      \
        const SimplexMesh<Dim>&, const std::vector<Eigen::Index>&, const std::string&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
