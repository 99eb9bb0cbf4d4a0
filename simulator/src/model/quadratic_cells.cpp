#include "model/quadratic_cells.h"

#include "model/gather_in_order.h"

#include <pent/dimensions.h>
#include <pent/equal_runs.h>
#include <pent/error.h>
#include <pent/formatted.h>

#include <Eigen/LU>

#include <algorithm>
#include <numeric>
#include <optional>

namespace pent::simulator {

namespace {

template <int Dim>
constexpr Eigen::Index kChildren = Eigen::Index{1} << Dim;

[[noreturn]] void refuse(const std::string& name, const std::string& found) {
    throw Error(name + ": " + found
                + ", expected cells that are the children of quadratic ones; make the mesh by"
                  " pent-mesh --quadratic, or take other elements");
}

// The rows of all ranks in order; of one process its own, one at most.
template <std::size_t Width>
std::vector<std::array<double, Width>> rows_of_all(
    const CellsOfRank& whole, const std::vector<std::array<double, Width>>& own) {
    return whole.ranks != nullptr ? gather_in_order(*whole.ranks, own) : own;
}

// Cells of the whole mesh.
template <int Dim>
Eigen::Index count_of(const SimplexMesh<Dim>& mesh, const CellsOfRank& whole) {
    return whole.ranks != nullptr ? whole.count : mesh.cell_count();
}

// The quadratic simplex that a cell is a child of: named by the mesh, or as children follow one
// another.
template <int Dim>
std::uint32_t parent_of(const SimplexMesh<Dim>& mesh, const CellsOfRank& whole, Eigen::Index cell) {
    return mesh.parents.empty() ? whole.number(cell) / static_cast<std::uint32_t>(kChildren<Dim>)
                                : mesh.parents[static_cast<std::size_t>(cell)];
}

// Cells with one parent that do not make up a quadratic cell. Every rank that has one of them has
// all.
struct Fault {
    std::uint32_t parent;
    std::string found;
};

// Throws on all ranks for the first fault that any of them has found.
void refuse_first(const std::string& name,
                  const std::optional<Fault>& own,
                  const CellsOfRank& whole) {
    std::vector<std::array<double, 1>> parents;
    if (own) {
        parents.push_back({static_cast<double>(own->parent)});
    }
    parents = rows_of_all(whole, parents);
    if (parents.empty()) {
        return;
    }
    agree(whole.ranks, [&] {
        if (own && own->parent == parents.front()[0]) {
            refuse(name, own->found);
        }
    });
}

// The vertices that only one of some cells has, which are the corners of their parent, each with
// its cell.
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

// Finds the nodes of one quadratic simplex, corners by increasing number but for orientation; false
// if the cells are not its children.
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

// The least Jacobian over that of straight edges: at quadrature points, and at nodes, where it is
// least if a middle has moved far.
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

// A quadratic simplex is judged by the rank that has its first corner.
template <int Dim>
void check_whole(const SimplexMesh<Dim>& mesh,
                 const QuadraticSimplices<Dim>& simplices,
                 const std::vector<Eigen::Index>& cells,
                 const std::string& name,
                 const CellsOfRank& whole) {
    double folded = 0;
    Eigen::Index worst = 0;
    double least = 0;
    for (Eigen::Index simplex = 0; simplex < simplices.cols(); ++simplex) {
        if (whole.ranks != nullptr && !whole.owns(simplices(0, simplex))) {
            continue;
        }
        const double jacobian =
            least_jacobian<Dim>(places_of_nodes<Dim>(mesh.positions, simplices, simplex));
        if (!(jacobian > 0)) {
            worst = folded == 0 || jacobian < least ? simplex : worst;
            least = folded == 0 ? jacobian : std::min(least, jacobian);
            ++folded;
        }
    }
    std::vector<std::array<double, 3>> found;  // least, its parent, how many
    if (folded > 0) {
        const Eigen::Index child = cells[static_cast<std::size_t>(worst * kChildren<Dim>)];
        found.push_back({least, static_cast<double>(parent_of(mesh, whole, child)), folded});
    }
    const std::vector<std::array<double, 3>> all = rows_of_all(whole, found);
    if (all.empty()) {
        return;
    }
    std::int64_t sum = 0;
    for (const auto& of_rank : all) {
        sum += static_cast<std::int64_t>(of_rank[2]);
    }
    agree(whole.ranks, [&] {
        if (found.empty() || found.front() != all.front()) {
            return;
        }
        std::string place;
        for (int axis = 0; axis < Dim; ++axis) {
            place += (axis == 0 ? "" : ", ")
                     + formatted("%.4g", mesh.positions(axis, simplices(0, worst)));
        }
        const Eigen::Index child = cells[static_cast<std::size_t>(worst * kChildren<Dim>)];
        throw Error(name + ": " + std::to_string(sum) + " of "
                    + std::to_string(count_of(mesh, whole) / kChildren<Dim>)
                    + " quadratic cells are folded at rest, the worst (a Jacobian of "
                    + formatted("%.3g", least) + " of that of straight edges) that of cell "
                    + std::to_string(whole.number(child)) + " at (" + place
                    + ") m, expected none; move the middles of their edges less");
    });
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
std::vector<Eigen::Index> child_cells(const SimplexMesh<Dim>& mesh,
                                      const std::string& name,
                                      const CellsOfRank& whole) {
    const Eigen::Index count = count_of(mesh, whole);
    if (count % kChildren<Dim> != 0) {
        refuse(name,
               std::to_string(count) + " cells, no multiple of " + std::to_string(kChildren<Dim>));
    }
    std::vector<Eigen::Index> cells(static_cast<std::size_t>(mesh.cell_count()));
    std::iota(cells.begin(), cells.end(), Eigen::Index{0});
    const auto parent = [&](Eigen::Index cell) { return parent_of(mesh, whole, cell); };
    std::stable_sort(cells.begin(), cells.end(),
                     [&](Eigen::Index a, Eigen::Index b) { return parent(a) < parent(b); });
    std::optional<Fault> fault;
    for_each_equal_run(
        cells, [&](Eigen::Index a, Eigen::Index b) { return parent(a) == parent(b); },
        [&](std::size_t first, std::size_t children) {
            if (!fault && children != static_cast<std::size_t>(kChildren<Dim>)) {
                const std::uint32_t number = parent(cells[first]);
                fault = {number, "parent " + std::to_string(number) + " with "
                                     + std::to_string(children) + " cells"};
            }
        });
    refuse_first(name, fault, whole);
    return cells;
}

template <int Dim>
QuadraticSimplices<Dim> quadratic_simplices(const SimplexMesh<Dim>& mesh,
                                            const std::vector<Eigen::Index>& cells,
                                            const std::string& name,
                                            const CellsOfRank& whole) {
    QuadraticSimplices<Dim> simplices(kQuadraticNodes<Dim>, mesh.cell_count() / kChildren<Dim>);
    std::optional<Fault> fault;
    for (Eigen::Index simplex = 0; !fault && simplex < simplices.cols(); ++simplex) {
        const Eigen::Index* children = cells.data() + simplex * kChildren<Dim>;
        Eigen::Matrix<std::uint32_t, kQuadraticNodes<Dim>, 1> nodes;
        if (find_nodes<Dim>(mesh, children, nodes)) {
            simplices.col(simplex) = nodes;
        } else {
            fault = {parent_of(mesh, whole, children[0]),
                     "cell " + std::to_string(whole.number(children[0])) + " and "
                         + std::to_string(kChildren<Dim> - 1)
                         + " more that do not make up one simplex with its edges cut in two"};
        }
    }
    refuse_first(name, fault, whole);
    check_whole<Dim>(mesh, simplices, cells, name, whole);
    return simplices;
}

#define PENT_INSTANTIATE(Dim)                                                                    \
    template Eigen::Matrix<double, Dim, Dim + 1> tangent_corners<Dim>(                           \
        const Eigen::Matrix<double, Dim, kQuadraticNodes<Dim>>&,                                 \
        const Eigen::Matrix<double, Dim + 1, 1>&);                                               \
    template Eigen::Matrix<double, Dim, kQuadraticNodes<Dim>> places_of_nodes<Dim>(              \
        const Positions<Dim>&, const QuadraticSimplices<Dim>&, Eigen::Index);                    \
    template QuadraticRest<Dim> quadratic_rest<Dim>(                                             \
        const Eigen::Matrix<double, Dim, kQuadraticNodes<Dim>>&);                                \
    template std::vector<Eigen::Index> child_cells<Dim>(const SimplexMesh<Dim>&,                 \
                                                        const std::string&, const CellsOfRank&); \
    template QuadraticSimplices<Dim> quadratic_simplices<Dim>(                                   \
        const SimplexMesh<Dim>&, const std::vector<Eigen::Index>&, const std::string&,           \
        const CellsOfRank&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
