#include "linear/dof_map.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace pent::simulator {

namespace {

// Neighbors of node i: targets[start[i]] .. targets[start[i + 1] - 1], increasing.
struct Graph {
    std::vector<std::int64_t> start;
    std::vector<std::uint32_t> targets;

    [[nodiscard]] std::uint32_t size() const {
        return static_cast<std::uint32_t>(start.size() - 1);
    }
    [[nodiscard]] std::int64_t degree(std::uint32_t node) const {
        return start[node + 1] - start[node];
    }
};

// Columns are joined when a cell has a free vertex of each.
template <int Dim>
Graph column_graph(const Simplices<Dim + 1>& cells,
                   const std::vector<bool>& is_fixed,
                   const std::vector<std::uint32_t>& columns,
                   std::uint32_t column_count) {
    const auto for_each_edge = [&](const auto& visit) {
        for (Eigen::Index cell = 0; cell < cells.cols(); ++cell) {
            for (int a = 0; a <= Dim; ++a) {
                for (int b = 0; b <= Dim; ++b) {
                    const std::uint32_t from = cells(a, cell);
                    const std::uint32_t to = cells(b, cell);
                    if (!is_fixed[from] && !is_fixed[to] && columns[from] != columns[to]) {
                        visit(columns[from], columns[to]);
                    }
                }
            }
        }
    };
    std::vector<std::int64_t> start(column_count + 1, 0);
    for_each_edge([&](std::uint32_t from, std::uint32_t /*to*/) { ++start[from + 1]; });
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<std::uint32_t> targets(static_cast<std::size_t>(start.back()));
    std::vector<std::int64_t> next(start.begin(), start.end() - 1);
    for_each_edge([&](std::uint32_t from, std::uint32_t to) {
        targets[static_cast<std::size_t>(next[from]++)] = to;
    });
    Graph graph;
    graph.start.push_back(0);
    for (std::uint32_t node = 0; node < column_count; ++node) {
        const auto first = targets.begin() + start[node];
        const auto last = targets.begin() + start[node + 1];
        std::sort(first, last);
        graph.targets.insert(graph.targets.end(), first, std::unique(first, last));
        graph.start.push_back(static_cast<std::int64_t>(graph.targets.size()));
    }
    return graph;
}

// Appends the nodes reached from `root` in breadth-first order, neighbors by increasing degree.
void breadth_first(const Graph& graph,
                   std::uint32_t root,
                   std::vector<bool>& is_seen,
                   std::vector<std::uint32_t>& order) {
    std::size_t next = order.size();
    order.push_back(root);
    is_seen[root] = true;
    std::vector<std::uint32_t> neighbors;
    while (next < order.size()) {
        const std::uint32_t node = order[next++];
        neighbors.clear();
        for (std::int64_t k = graph.start[node]; k < graph.start[node + 1]; ++k) {
            const std::uint32_t neighbor = graph.targets[static_cast<std::size_t>(k)];
            if (!is_seen[neighbor]) {
                is_seen[neighbor] = true;
                neighbors.push_back(neighbor);
            }
        }
        std::stable_sort(neighbors.begin(), neighbors.end(), [&](std::uint32_t a, std::uint32_t b) {
            return graph.degree(a) < graph.degree(b);
        });
        order.insert(order.end(), neighbors.begin(), neighbors.end());
    }
}

std::vector<std::uint32_t> reverse_cuthill_mckee(const Graph& graph) {
    std::vector<std::uint32_t> order;
    order.reserve(graph.size());
    std::vector<bool> is_seen(graph.size(), false);
    for (std::uint32_t node = 0; node < graph.size(); ++node) {
        if (is_seen[node]) {
            continue;
        }
        // A good root is far out, and the node that a breadth-first search reaches last is.
        const std::size_t begin = order.size();
        std::uint32_t root = node;
        for (int pass = 0; pass < 2; ++pass) {
            breadth_first(graph, root, is_seen, order);
            root = order.back();
            for (std::size_t i = begin; i < order.size(); ++i) {
                is_seen[order[i]] = false;
            }
            order.resize(begin);
        }
        breadth_first(graph, root, is_seen, order);
    }
    std::reverse(order.begin(), order.end());
    return order;
}

}  // namespace

DofMap::DofMap(std::size_t vertices,
               std::vector<std::uint32_t> vertex_of_dof,
               std::vector<std::uint32_t> column_start,
               std::vector<bool> is_own)
    : index_(vertices),
      vertex_of_dof_(std::move(vertex_of_dof)),
      column_start_(std::move(column_start)),
      is_own_(std::move(is_own)) {
    for (std::uint32_t vertex = 0; vertex < vertices; ++vertex) {
        index_[vertex] = count() + vertex;
    }
    for (std::uint32_t dof = 0; dof < count(); ++dof) {
        index_[vertex_of_dof_[dof]] = dof;
    }
}

template <int Dim>
DofMap number_dofs(const Simplices<Dim + 1>& cells,
                   const std::vector<bool>& is_fixed,
                   const Columns& columns) {
    const std::size_t vertices = is_fixed.size();
    std::uint32_t column_count = 0;
    for (const std::uint32_t column : columns.columns) {
        column_count = std::max(column_count, column + 1);
    }
    std::vector<std::vector<std::uint32_t>> members(column_count);
    for (std::uint32_t vertex = 0; vertex < vertices; ++vertex) {
        if (!is_fixed[vertex]) {
            members[columns.columns[vertex]].push_back(vertex);
        }
    }
    std::vector<std::uint32_t> vertex_of_dof;
    std::vector<std::uint32_t> column_start = {0};
    const Graph graph = column_graph<Dim>(cells, is_fixed, columns.columns, column_count);
    for (const std::uint32_t column : reverse_cuthill_mckee(graph)) {
        std::vector<std::uint32_t>& of_column = members[column];
        if (of_column.empty()) {
            continue;
        }
        std::stable_sort(of_column.begin(), of_column.end(), [&](std::uint32_t a, std::uint32_t b) {
            return columns.layers[a] < columns.layers[b];
        });
        vertex_of_dof.insert(vertex_of_dof.end(), of_column.begin(), of_column.end());
        column_start.push_back(static_cast<std::uint32_t>(vertex_of_dof.size()));
    }
    return {vertices, std::move(vertex_of_dof), std::move(column_start)};
}

#define PENT_INSTANTIATE(Dim)                                                             \
    template DofMap number_dofs<Dim>(const Simplices<Dim + 1>&, const std::vector<bool>&, \
                                     const Columns&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
