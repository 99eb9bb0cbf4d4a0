#include "model/nearest_in_body.h"

#include "model/gather_in_order.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>

namespace pent::simulator {

namespace {

// Vertices that are searched for at a time, which bounds what ranks gather.
constexpr std::size_t kPiece = 65536;

// The cells of a body that are searched here: each of them on one rank.
template <int Dim>
std::vector<Eigen::Index> cells_here(const Bodies<Dim>& bodies, std::size_t body) {
    const auto range = bodies.cells_of(body);
    std::vector<Eigen::Index> cells;
    for (Eigen::Index cell = range.begin; cell < range.begin + range.size; ++cell) {
        if (bodies.sharing.owns(bodies.cells()(0, cell))) {
            cells.push_back(cell);
        }
    }
    return cells;
}

// The least of each number over ranks.
void take_least(const Sharing& sharing, std::vector<double>& values) {
    if (!sharing.is_shared()) {
        return;
    }
    const std::vector<std::int64_t> sizes(static_cast<std::size_t>(sharing.ranks().count()),
                                          static_cast<std::int64_t>(values.size()));
    const std::vector<double> all = sharing.ranks().gather(values, sizes);
    for (std::size_t i = 0; i < all.size(); ++i) {
        double& least = values[i % values.size()];
        least = std::min(least, all[i]);
    }
}

// What ranks gather: a vertex, where its cell would be if all were here (its range, and its number
// in the mesh), the distance, and the point in the cell.
template <int Dim>
using Row = std::array<double, 4 + 2 * (Dim + 1)>;

template <int Dim>
Row<Dim> row_of(const Bodies<Dim>& bodies,
                std::size_t vertex,
                Eigen::Index cell,
                const MaterialPoint<Dim>& point) {
    const auto range =
        std::find_if(bodies.ranges.begin(), bodies.ranges.end(),
                     [&](const CellRange& one) { return one.begin <= cell && cell < one.end; });
    Row<Dim> row = {static_cast<double>(vertex), static_cast<double>(range - bodies.ranges.begin()),
                    static_cast<double>(bodies.mesh_cell(range->body, cell)), point.distance};
    std::copy(point.weights.begin(), point.weights.end(), row.begin() + 4);
    std::copy(point.vertices.begin(), point.vertices.end(), row.begin() + 4 + Dim + 1);
    return row;
}

template <int Dim>
MaterialPoint<Dim> point_of(const Row<Dim>& row) {
    MaterialPoint<Dim> point;
    point.distance = row[3];
    std::copy_n(row.begin() + 4, Dim + 1, point.weights.begin());
    std::transform(row.begin() + 4 + Dim + 1, row.end(), point.vertices.begin(),
                   [](double vertex) { return static_cast<std::uint32_t>(vertex); });
    return point;
}

// Finds the nearest points of some vertices, each at its place in `found`.
template <int Dim>
void search(const Workers& workers,
            const Bodies<Dim>& bodies,
            const std::vector<Eigen::Index>& cells,
            const NearestPointSearch<Dim>& search,
            std::span<const std::uint32_t> vertices,
            std::span<MaterialPoint<Dim>> found) {
    std::vector<double> distances(vertices.size());
    workers.for_each(vertices.size(), [&](std::size_t i) {
        distances[i] = search.distance(bodies.rest().col(vertices[i]));
    });
    take_least(bodies.sharing, distances);
    std::vector<std::optional<Eigen::Index>> here(vertices.size());
    workers.for_each(vertices.size(), [&](std::size_t i) {
        const Vector<Dim> point = bodies.rest().col(vertices[i]);
        here[i] = search.first_at(point, distances[i]);
        if (here[i]) {
            found[i] = search.nearest_in(*here[i], point);
        }
    });
    if (!bodies.sharing.is_shared()) {
        return;
    }
    std::vector<Row<Dim>> own;
    for (std::size_t i = 0; i < here.size(); ++i) {
        if (here[i]) {
            own.push_back(row_of(bodies, i, cells[static_cast<std::size_t>(*here[i])], found[i]));
        }
    }
    const auto rows = gather_in_order(bodies.sharing.ranks(), own);
    for (std::size_t i = rows.size(); i-- > 0;) {  // the first of each vertex last
        found[static_cast<std::size_t>(rows[i][0])] = point_of<Dim>(rows[i]);
    }
}

}  // namespace

template <int Dim>
MaterialPoints<Dim> nearest_in_body(const Workers& workers,
                                    const Bodies<Dim>& bodies,
                                    std::size_t body,
                                    const std::vector<std::uint32_t>& vertices) {
    const std::vector<Eigen::Index> cells = cells_here(bodies, body);
    const NearestPointSearch<Dim> tree(bodies.rest(), bodies.cells()(Eigen::all, cells));
    MaterialPoints<Dim> found(vertices.size());
    for (std::size_t first = 0; first < vertices.size(); first += kPiece) {
        const std::size_t size = std::min(kPiece, vertices.size() - first);
        search<Dim>(workers, bodies, cells, tree, std::span(vertices).subspan(first, size),
                    std::span(found).subspan(first, size));
    }
    return found;
}

#define PENT_INSTANTIATE(Dim)                                                                     \
    template MaterialPoints<Dim> nearest_in_body(const Workers&, const Bodies<Dim>&, std::size_t, \
                                                 const std::vector<std::uint32_t>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
