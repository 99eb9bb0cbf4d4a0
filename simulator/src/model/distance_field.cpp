#include "model/distance_field.h"

#include "model/falling_values.h"

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

// When a plane wave that passes some points at given times arrives at another: the local solver of
// fast marching. Infinite if it does not come from between them.
//
// The gradient g of its time, of length 1, lies in the span of V, the ways from the points, and has
// V^T g = T - t. The weights w of g = V w tell through which point between them the wave comes. The
// result is the way to that point and from there: as that is the shortest, an error in the weights
// counts to second order alone.
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
    if (!(a > 0 && root > 0)) {
        return kUnknown;
    }
    const Column weights = (b + std::sqrt(root)) / a * q_ones - q_t;
    if (!(weights.array() >= 0).all()) {
        return kUnknown;
    }
    const Column parts = weights / weights.sum();
    return first + parts.dot(t) + (ways * parts).norm();
}

// Fast marching: distances as they fall. A vertex whose distance has fallen is in the queue until
// it is settled; only then do waves pass through it, with whatever is settled later.
template <int Dim>
class Front {
public:
    explicit Front(const MeshShare<Dim>& share)
        : share_(share),
          at_(cells_at_vertices(share.mesh)),
          times_(Eigen::VectorXd::Constant(share.mesh.vertex_count(), kUnknown)),
          is_settled_(static_cast<std::size_t>(share.mesh.vertex_count()), false) {}

    [[nodiscard]] Eigen::VectorXd& times() { return times_; }

    void lower(std::uint32_t vertex, double time) {
        times_[vertex] = time;
        is_settled_[vertex] = false;
        queue_.emplace(time, vertex);
    }

    // Goes on until all is settled.
    void march() {
        while (!queue_.empty()) {
            const auto [time, next] = queue_.top();
            queue_.pop();
            if (time > times_[next] || is_settled_[next]) {
                continue;
            }
            is_settled_[next] = true;
            for (std::size_t i = at_.start[next]; i < at_.start[next + 1U]; ++i) {
                for (const std::uint32_t vertex : share_.mesh.cells.col(at_.cells[i])) {
                    if (vertex == next || !share_.owns(vertex)) {
                        continue;
                    }
                    const double earliest = earliest_arrival(at_.cells[i], vertex, next);
                    if (earliest < times_[vertex]) {
                        lower(vertex, earliest);
                    }
                }
            }
        }
    }

private:
    using Way = Eigen::Matrix<double, Dim, 1>;
    using Entry = std::pair<double, std::uint32_t>;

    // The earliest arrival at a corner of a cell of waves that come through another and any others
    // that are settled.
    [[nodiscard]] double earliest_arrival(Eigen::Index cell,
                                          std::uint32_t vertex,
                                          std::uint32_t through) const {
        const Positions<Dim>& x = share_.mesh.positions;
        const Way way = x.col(vertex) - x.col(through);
        std::vector<std::uint32_t> others;
        bool is_obtuse = false;
        for (const std::uint32_t corner : share_.mesh.cells.col(cell)) {
            if (corner != vertex && corner != through && is_settled_[corner]) {
                others.push_back(corner);
                is_obtuse = is_obtuse || way.dot(x.col(vertex) - x.col(corner)) < 0;
            }
        }
        // Where ways meet at no obtuse angle nothing arrives earlier than where it comes from.
        if (!is_obtuse && times_[vertex] <= times_[through]) {
            return kUnknown;
        }
        double earliest = kUnknown;
        for (std::uint32_t chosen = 0; chosen < (1U << others.size()); ++chosen) {
            Eigen::Matrix<double, Dim, Eigen::Dynamic, 0, Dim, Dim> ways(Dim, 1);
            Eigen::Matrix<double, Eigen::Dynamic, 1, 0, Dim, 1> known(1);
            ways.col(0) = way;
            known[0] = times_[through];
            for (std::size_t k = 0; k < others.size(); ++k) {
                if ((chosen >> k & 1U) != 0) {
                    const Eigen::Index column = ways.cols();
                    ways.conservativeResize(Dim, column + 1);
                    known.conservativeResize(column + 1);
                    ways.col(column) = x.col(vertex) - x.col(others[k]);
                    known[column] = times_[others[k]];
                }
            }
            earliest = std::min(earliest, arrival<Dim>(ways, known));
        }
        return earliest;
    }

    const MeshShare<Dim>& share_;
    CellsAtVertices at_;
    Eigen::VectorXd times_;
    std::vector<bool> is_settled_;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace

template <int Dim>
Eigen::VectorXd distance_within(const MeshShare<Dim>& share,
                                const std::vector<std::uint32_t>& sources) {
    Front<Dim> front(share);
    for (const std::uint32_t source : sources) {
        front.lower(source, 0);
    }
    FallingValues others(share);
    for (bool has_fallen = true; has_fallen;) {
        front.march();
        const std::vector<std::uint32_t> fallen = others.take_over(front.times());
        for (const std::uint32_t vertex : fallen) {
            front.lower(vertex, front.times()[vertex]);
        }
        has_fallen = others.any(!fallen.empty());
    }
    return front.times();
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
    template Eigen::VectorXd distance_within(const MeshShare<Dim>&,                                \
                                             const std::vector<std::uint32_t>&);                   \
    template Eigen::Matrix<double, Dim, 1> gradient_in_cell(const SimplexMesh<Dim>&, Eigen::Index, \
                                                            const Eigen::VectorXd&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
