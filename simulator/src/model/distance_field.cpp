#include "model/distance_field.h"

#include <pent/dimensions.h>
#include <pent/geometry.h>

#include <Eigen/LU>

#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace pent::simulator {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::infinity();

// The cells at each vertex, those of vertex v at [start[v], start[v + 1]).
struct CellsAtVertices {
    std::vector<std::size_t> start;
    std::vector<Eigen::Index> cells;
};

template <int Dim>
CellsAtVertices cells_at_vertices(const SimplexMesh<Dim>& mesh) {
    CellsAtVertices at;
    at.start.assign(static_cast<std::size_t>(mesh.vertex_count()) + 1, 0);
    for (const std::uint32_t vertex : mesh.cells.reshaped()) {
        ++at.start[vertex + 1U];
    }
    for (std::size_t v = 1; v < at.start.size(); ++v) {
        at.start[v] += at.start[v - 1];
    }
    at.cells.resize(at.start.back());
    std::vector<std::size_t> next(at.start.begin(), at.start.end() - 1);
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        for (const std::uint32_t vertex : mesh.cells.col(cell)) {
            at.cells[next[vertex]++] = cell;
        }
    }
    return at;
}

// When a plane wave that passes some points at given times arrives at another; infinite if it does
// not come from between them.
//
// Its gradient g, of length 1, lies in the span of V, the ways from the points: V^T g = T - t.
template <int Dim>
double arrival(const Eigen::Matrix<double, Dim, Eigen::Dynamic, 0, Dim, Dim>& ways,
               const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, Dim, 1>& times) {
    using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, Dim, Dim>;
    using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, Dim, 1>;
    const Column ones = Column::Ones(times.size());
    const double first = times.minCoeff();  // times count from it, for less rounding
    const Column t = times - first * ones;
    const Square products = ways.transpose() * ways;
    const Eigen::PartialPivLU<Square> lu(products);
    const Column q_ones = lu.solve(ones);
    const Column q_t = lu.solve(t);
    const double a = ones.dot(q_ones);
    const double b = ones.dot(q_t);
    const double root = b * b - a * (t.dot(q_t) - 1);
    if (!(a > 0 && root >= 0)) {
        return kUnknown;
    }
    const double T = (b + std::sqrt(root)) / a;
    const Column weights = T * q_ones - q_t;
    return (weights.array() >= 0).all() ? first + T : kUnknown;
}

// The earliest arrival at a corner of a cell of waves that come through another, whose time has
// just become known, and any others with known ones.
template <int Dim>
double earliest_arrival(const SimplexMesh<Dim>& mesh,
                        Eigen::Index cell,
                        std::uint32_t vertex,
                        std::uint32_t through,
                        const Eigen::VectorXd& times,
                        const std::vector<bool>& is_known) {
    std::vector<std::uint32_t> others;
    for (const std::uint32_t corner : mesh.cells.col(cell)) {
        if (corner != vertex && corner != through && is_known[corner]) {
            others.push_back(corner);
        }
    }
    double earliest = kUnknown;
    for (std::uint32_t chosen = 0; chosen < (1U << others.size()); ++chosen) {
        Eigen::Matrix<double, Dim, Eigen::Dynamic, 0, Dim, Dim> ways(Dim, 1);
        Eigen::Matrix<double, Eigen::Dynamic, 1, 0, Dim, 1> known(1);
        const auto add = [&](Eigen::Index i, std::uint32_t corner) {
            ways.conservativeResize(Dim, i + 1);
            known.conservativeResize(i + 1);
            ways.col(i) = mesh.positions.col(vertex) - mesh.positions.col(corner);
            known[i] = times[corner];
        };
        add(0, through);
        for (std::size_t k = 0; k < others.size(); ++k) {
            if ((chosen >> k & 1U) != 0) {
                add(ways.cols(), others[k]);
            }
        }
        earliest = std::min(earliest, arrival<Dim>(ways, known));
    }
    return earliest;
}

}  // namespace

template <int Dim>
Eigen::VectorXd distance_within(const SimplexMesh<Dim>& mesh,
                                const std::vector<std::uint32_t>& sources) {
    const CellsAtVertices at = cells_at_vertices(mesh);
    Eigen::VectorXd times = Eigen::VectorXd::Constant(mesh.vertex_count(), kUnknown);
    std::vector<bool> is_known(static_cast<std::size_t>(mesh.vertex_count()), false);
    using Entry = std::pair<double, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
    for (const std::uint32_t source : sources) {
        times[source] = 0;
        front.emplace(0, source);
    }
    while (!front.empty()) {
        const std::uint32_t next = front.top().second;
        front.pop();
        if (is_known[next]) {
            continue;
        }
        is_known[next] = true;
        for (std::size_t i = at.start[next]; i < at.start[next + 1U]; ++i) {
            for (const std::uint32_t vertex : mesh.cells.col(at.cells[i])) {
                if (is_known[vertex]) {
                    continue;
                }
                const double time =
                    earliest_arrival(mesh, at.cells[i], vertex, next, times, is_known);
                if (time < times[vertex]) {
                    times[vertex] = time;
                    front.emplace(time, vertex);
                }
            }
        }
    }
    return times;
}

template <int Dim>
Eigen::Matrix<double, Dim, 1> gradient_in_cell(const SimplexMesh<Dim>& mesh,
                                               Eigen::Index cell,
                                               const Eigen::VectorXd& values) {
    Eigen::Matrix<double, Dim, 1> rise;
    for (int a = 0; a < Dim; ++a) {
        rise[a] = values[mesh.cells(a + 1, cell)] - values[mesh.cells(0, cell)];
    }
    return edge_matrix<Dim>(mesh.positions, mesh.cells, cell)
        .transpose()
        .partialPivLu()
        .solve(rise);
}

#define PENT_INSTANTIATE(Dim)                                                                      \
    template Eigen::VectorXd distance_within(const SimplexMesh<Dim>&,                              \
                                             const std::vector<std::uint32_t>&);                   \
    template Eigen::Matrix<double, Dim, 1> gradient_in_cell(const SimplexMesh<Dim>&, Eigen::Index, \
                                                            const Eigen::VectorXd&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
