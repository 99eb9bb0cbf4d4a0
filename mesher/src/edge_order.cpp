
#include <pent/counted.h>
#include <pent/error.h>
#include <pent/mesher/edge_order.h>
#include <pent/text_reader.h>

#include <algorithm>
#include <array>
#include <boost/graph/compressed_sparse_row_graph.hpp>
#include <boost/graph/topological_sort.hpp>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

namespace pent::mesher {

namespace {

using Edge = std::uint64_t;  // the first vertex in the upper half, so that edges sort by it

Edge make_edge(std::uint32_t from, std::uint32_t to) {
    return (Edge{from} << 32U) | to;
}

std::uint32_t from_of(Edge edge) {
    return static_cast<std::uint32_t>(edge >> 32U);
}

std::uint32_t to_of(Edge edge) {
    return static_cast<std::uint32_t>(edge);
}

Edge undirected(Edge edge) {
    return make_edge(std::min(from_of(edge), to_of(edge)), std::max(from_of(edge), to_of(edge)));
}

std::string name(Edge edge) {
    return std::to_string(from_of(edge)) + " " + std::to_string(to_of(edge));
}

template <int Dim>
std::vector<Edge> undirected_edges(const Simplices<Dim + 1>& cells) {
    std::vector<Edge> edges;
    edges.reserve(cells.cols() * Dim * (Dim + 1) / 2);
    for (Eigen::Index cell = 0; cell < cells.cols(); ++cell) {
        for (int i = 0; i <= Dim; ++i) {
            for (int j = i + 1; j <= Dim; ++j) {
                edges.push_back(undirected(make_edge(cells(i, cell), cells(j, cell))));
            }
        }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

// The directed edges sorted, after a check that they are exactly those of the mesh.
std::vector<Edge> checked_edges(const std::vector<Edge>& of_mesh, const DirectedEdges& directed) {
    std::vector<Edge> edges(directed.cols());
    std::vector<Edge> plain(directed.cols());
    for (Eigen::Index i = 0; i < directed.cols(); ++i) {
        edges[i] = make_edge(directed(0, i), directed(1, i));
        plain[i] = undirected(edges[i]);
    }
    std::sort(edges.begin(), edges.end());
    std::sort(plain.begin(), plain.end());
    const auto twice = std::adjacent_find(plain.begin(), plain.end());
    if (twice != plain.end()) {
        throw Error("edge directions: edge " + name(*twice)
                    + " is there twice; expected each edge of the mesh once");
    }
    const auto [extra, missing] =
        std::mismatch(plain.begin(), plain.end(), of_mesh.begin(), of_mesh.end());
    if (extra != plain.end() && (missing == of_mesh.end() || *extra < *missing)) {
        throw Error("edge directions: " + name(*extra) + " is not an edge of the mesh");
    }
    if (missing != of_mesh.end()) {
        throw Error("edge directions: edge " + name(*missing) + " of the mesh has none");
    }
    return edges;
}

// Ranks by a topological sort of the graph of all edges; none if it has a cycle.
std::optional<std::vector<std::uint32_t>> topological_ranks(const std::vector<Edge>& edges,
                                                            Eigen::Index vertices) {
    using Graph =
        boost::compressed_sparse_row_graph<boost::directedS, boost::no_property, boost::no_property,
                                           boost::no_property, std::uint32_t>;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    pairs.reserve(edges.size());
    for (const Edge edge : edges) {
        pairs.emplace_back(from_of(edge), to_of(edge));
    }
    const Graph graph(boost::edges_are_sorted, pairs.begin(), pairs.end(),
                      static_cast<std::uint32_t>(vertices));
    std::vector<std::uint32_t> last_to_first;
    last_to_first.reserve(vertices);
    try {
        boost::topological_sort(graph, std::back_inserter(last_to_first));
    } catch (const boost::not_a_dag&) {
        return std::nullopt;
    }
    std::vector<std::uint32_t> ranks(vertices);
    for (std::size_t i = 0; i < last_to_first.size(); ++i) {
        ranks[last_to_first[i]] = static_cast<std::uint32_t>(last_to_first.size() - 1 - i);
    }
    return ranks;
}

// Sorts the few corners of a cell; returns whether the permutation was odd.
template <std::size_t Size, typename IsBefore>
bool sort_corners(std::array<std::uint32_t, Size>& corners, IsBefore is_before) {
    bool is_odd = false;
    for (std::size_t i = 1; i < Size; ++i) {
        for (std::size_t j = i; j > 0 && is_before(corners[j], corners[j - 1]); --j) {
            std::swap(corners[j], corners[j - 1]);
            is_odd = !is_odd;
        }
    }
    return is_odd;
}

template <int Dim, typename IsBefore>
OrderedCells<Dim> sort_cells(const Simplices<Dim + 1>& cells, IsBefore is_before) {
    OrderedCells<Dim> ordered;
    ordered.cells.resize(Dim + 1, cells.cols());
    ordered.is_odd.resize(cells.cols());
    for (Eigen::Index cell = 0; cell < cells.cols(); ++cell) {
        std::array<std::uint32_t, Dim + 1> corners{};
        std::copy_n(cells.col(cell).data(), Dim + 1, corners.begin());
        ordered.is_odd[cell] = sort_corners(corners, is_before) ? 1 : 0;
        std::copy_n(corners.begin(), Dim + 1, ordered.cells.col(cell).data());
    }
    return ordered;
}

bool has_edge(const std::vector<Edge>& edges, std::uint32_t from, std::uint32_t to) {
    return std::binary_search(edges.begin(), edges.end(), make_edge(from, to));
}

// Triangles of the mesh whose three edges run around, each once, starting at its lowest vertex.
template <int Dim>
std::vector<std::array<std::uint32_t, 3>> cyclic_triangles(const Simplices<Dim + 1>& cells,
                                                           const std::vector<Edge>& edges) {
    std::vector<std::array<std::uint32_t, 3>> found;
    for (Eigen::Index cell = 0; cell < cells.cols(); ++cell) {
        for (int i = 0; i <= Dim; ++i) {
            for (int j = i + 1; j <= Dim; ++j) {
                for (int k = j + 1; k <= Dim; ++k) {
                    std::array<std::uint32_t, 3> t = {cells(i, cell), cells(j, cell),
                                                      cells(k, cell)};
                    std::sort(t.begin(), t.end());
                    const bool is_up = has_edge(edges, t[0], t[1]);
                    if (is_up == has_edge(edges, t[1], t[2])
                        && is_up == has_edge(edges, t[2], t[0])) {
                        found.push_back(is_up ? t : std::array{t[0], t[2], t[1]});
                    }
                }
            }
        }
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

[[noreturn]] void refuse(const std::vector<std::array<std::uint32_t, 3>>& cycles) {
    constexpr std::size_t kListed = 8;
    std::string text;
    for (std::size_t i = 0; i < std::min(cycles.size(), kListed); ++i) {
        text += (i == 0 ? "" : ", ") + std::to_string(cycles[i][0]) + " -> "
                + std::to_string(cycles[i][1]) + " -> " + std::to_string(cycles[i][2]);
    }
    throw Error(
        "edge directions: "
        + counted(cycles.size(), "triangle is a directed cycle", "triangles are directed cycles")
        + ": " + text + (cycles.size() > kListed ? ", ..." : "")
        + "; turn one edge of each, no such prism can be cut");
}

}  // namespace

template <int Dim>
DirectedEdges edges_of(const Simplices<Dim + 1>& cells) {
    const std::vector<Edge> edges = undirected_edges<Dim>(cells);
    DirectedEdges result(2, edges.size());
    for (std::size_t i = 0; i < edges.size(); ++i) {
        result.col(static_cast<Eigen::Index>(i)) << from_of(edges[i]), to_of(edges[i]);
    }
    return result;
}

template <int Dim>
DirectedEdges direct_edges(const SimplexMesh<Dim>& mesh, const std::vector<std::uint32_t>& ranks) {
    DirectedEdges edges = edges_of<Dim>(mesh.cells);
    for (auto edge : edges.colwise()) {
        if (ranks[edge[0]] > ranks[edge[1]]) {
            std::swap(edge[0], edge[1]);
        }
    }
    return edges;
}

template <int Dim>
std::vector<std::uint32_t> rank_vertices(const SimplexMesh<Dim>& mesh, VertexOrder order) {
    std::vector<std::uint32_t> first_to_last(mesh.vertex_count());
    std::iota(first_to_last.begin(), first_to_last.end(), 0U);
    if (order == VertexOrder::Sweep) {
        Eigen::Index axis = 0;
        (mesh.positions.rowwise().maxCoeff() - mesh.positions.rowwise().minCoeff()).maxCoeff(&axis);
        std::stable_sort(first_to_last.begin(), first_to_last.end(),
                         [&](std::uint32_t a, std::uint32_t b) {
                             return mesh.positions(axis, a) < mesh.positions(axis, b);
                         });
    }
    std::vector<std::uint32_t> ranks(first_to_last.size());
    for (std::size_t i = 0; i < first_to_last.size(); ++i) {
        ranks[first_to_last[i]] = static_cast<std::uint32_t>(i);
    }
    return ranks;
}

template <int Dim>
OrderedCells<Dim> order_cells(const SimplexMesh<Dim>& mesh, const DirectedEdges& directed) {
    const std::vector<Edge> edges = checked_edges(undirected_edges<Dim>(mesh.cells), directed);
    if (const auto ranks = topological_ranks(edges, mesh.vertex_count())) {
        return sort_cells<Dim>(mesh.cells, [&](std::uint32_t a, std::uint32_t b) {
            return (*ranks)[a] < (*ranks)[b];
        });
    }
    const auto cycles = cyclic_triangles<Dim>(mesh.cells, edges);
    if (!cycles.empty()) {
        refuse(cycles);
    }
    return sort_cells<Dim>(mesh.cells,
                           [&](std::uint32_t a, std::uint32_t b) { return has_edge(edges, a, b); });
}

DirectedEdges read_directed_edges(const std::filesystem::path& path, std::int64_t vertices) {
    TextReader text(path);
    std::vector<std::uint32_t> ends;
    while (text.next_line()) {
        for (int i = 0; i < 2; ++i) {
            const std::int64_t vertex = text.integer(text.word(), "a vertex");
            if (vertex < 0 || vertex >= vertices) {
                text.fail("vertex " + std::to_string(vertex) + " of " + std::to_string(vertices));
            }
            ends.push_back(static_cast<std::uint32_t>(vertex));
        }
        if (!text.word().empty()) {
            text.fail("more than two vertices; expected one edge a line");
        }
    }
    return Eigen::Map<const DirectedEdges>(ends.data(), 2,
                                           static_cast<Eigen::Index>(ends.size() / 2));
}

#define PENT_INSTANTIATE(Dim)                                                                     \
    template DirectedEdges edges_of<Dim>(const Simplices<Dim + 1>&);                              \
    template DirectedEdges direct_edges<Dim>(const SimplexMesh<Dim>&,                             \
                                             const std::vector<std::uint32_t>&);                  \
    template std::vector<std::uint32_t> rank_vertices<Dim>(const SimplexMesh<Dim>&, VertexOrder); \
    template OrderedCells<Dim> order_cells<Dim>(const SimplexMesh<Dim>&, const DirectedEdges&);

PENT_INSTANTIATE(1)
PENT_INSTANTIATE(2)
PENT_INSTANTIATE(3)

#undef PENT_INSTANTIATE

}  // namespace pent::mesher
