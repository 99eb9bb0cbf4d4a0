#include "pent/viewer/boundary.h"

#include <pent/error.h>
#include <pent/facets.h>

#include <algorithm>
#include <string>
#include <utility>

namespace pent::viewer {

namespace {

// Turns counts stored one place up (count of bucket i at [i + 1]) into the begins of the buckets.
void accumulate(std::vector<std::uint32_t>& begins) {
    for (std::size_t i = 1; i < begins.size(); ++i) {
        begins[i] += begins[i - 1];
    }
}

template <int Dim>
void index_vertices(Boundary<Dim>& boundary, Eigen::Index vertices) {
    boundary.vertex_begin.assign(static_cast<std::size_t>(vertices) + 1, 0);
    for (const std::uint32_t vertex : boundary.facets.reshaped()) {
        ++boundary.vertex_begin[vertex + 1];
    }
    accumulate(boundary.vertex_begin);
    boundary.vertex_facets.resize(static_cast<std::size_t>(boundary.facets.size()));
    std::vector<std::uint32_t> next(boundary.vertex_begin.begin(), boundary.vertex_begin.end() - 1);
    for (Eigen::Index facet = 0; facet < boundary.facets.cols(); ++facet) {
        for (const std::uint32_t vertex : boundary.facets.col(facet)) {
            boundary.vertex_facets[next[vertex]++] = static_cast<std::uint32_t>(facet);
        }
    }
}

// Calls action(k, low, high) for the k-th edge of a facet, its vertices in ascending order.
template <int Dim, typename Action>
void for_each_edge(const Eigen::Matrix<std::uint32_t, Dim, 1>& facet, Action action) {
    int k = 0;
    for (int i = 0; i < Dim; ++i) {
        for (int j = i + 1; j < Dim; ++j) {
            action(k++, std::min(facet[i], facet[j]), std::max(facet[i], facet[j]));
        }
    }
}

// Edges are bucketed by their lower vertex; each bucket is sorted and made unique, so that the
// whole is linear in the number of facets.
template <int Dim>
void index_edges(Boundary<Dim>& boundary, Eigen::Index vertices) {
    std::vector<std::uint32_t> begins(static_cast<std::size_t>(vertices) + 1, 0);
    for (Eigen::Index f = 0; f < boundary.facets.cols(); ++f) {
        for_each_edge<Dim>(boundary.facets.col(f),
                           [&](int, std::uint32_t low, std::uint32_t) { ++begins[low + 1]; });
    }
    accumulate(begins);
    std::vector<std::uint32_t> highs(begins.back());
    std::vector<std::uint32_t> next(begins.begin(), begins.end() - 1);
    for (Eigen::Index f = 0; f < boundary.facets.cols(); ++f) {
        for_each_edge<Dim>(boundary.facets.col(f), [&](int, std::uint32_t low, std::uint32_t high) {
            highs[next[low]++] = high;
        });
    }
    std::vector<std::uint32_t> unique_highs;
    std::vector<std::uint32_t> unique_begins(begins.size(), 0);
    for (std::size_t low = 0; low + 1 < begins.size(); ++low) {
        const auto begin = highs.begin() + begins[low];
        const auto end = highs.begin() + begins[low + 1];
        std::sort(begin, end);
        unique_highs.insert(unique_highs.end(), begin, std::unique(begin, end));
        unique_begins[low + 1] = static_cast<std::uint32_t>(unique_highs.size());
    }
    boundary.edges.resize(2, static_cast<Eigen::Index>(unique_highs.size()));
    for (std::size_t low = 0; low + 1 < unique_begins.size(); ++low) {
        for (std::uint32_t e = unique_begins[low]; e < unique_begins[low + 1]; ++e) {
            boundary.edges.col(e) << static_cast<std::uint32_t>(low), unique_highs[e];
        }
    }
    boundary.facet_edges.resize(boundary.kFacetEdges, boundary.facets.cols());
    for (Eigen::Index f = 0; f < boundary.facets.cols(); ++f) {
        for_each_edge<Dim>(boundary.facets.col(f), [&](int k, std::uint32_t low,
                                                       std::uint32_t high) {
            const auto found =
                std::lower_bound(unique_highs.begin() + unique_begins[low],
                                 unique_highs.begin() + unique_begins[low + 1], high);
            boundary.facet_edges(k, f) = static_cast<std::uint32_t>(found - unique_highs.begin());
        });
    }
}

}  // namespace

template <int Dim>
Boundary<Dim> make_boundary(const SimplexMesh<Dim>& mesh, std::string_view name) {
    FacetMatch<Dim> match = match_facets<Dim>(mesh.cells, mesh.vertex_count());
    if (!match.is_conforming()) {
        throw Error(
            std::string(name) + ": " + std::string(cell_name(Dim)) + " "
            + std::to_string(match.first_fault) + ": does not fit its neighbors ("
            + std::to_string(match.one_sided) + " facets seen twice from one side, "
            + std::to_string(match.overfull)
            + " shared by more than two cells); expected a conforming mesh, see pent-check");
    }
    return index_boundary<Dim>(std::move(match.boundary), mesh.vertex_count());
}

template <int Dim>
Boundary<Dim> index_boundary(Simplices<Dim> facets, Eigen::Index vertices) {
    Boundary<Dim> boundary;
    boundary.facets = std::move(facets);
    index_vertices<Dim>(boundary, vertices);
    index_edges<Dim>(boundary, vertices);
    return boundary;
}

template Boundary<3> make_boundary<3>(const SimplexMesh<3>& mesh, std::string_view name);
template Boundary<4> make_boundary<4>(const SimplexMesh<4>& mesh, std::string_view name);
template Boundary<3> index_boundary<3>(Simplices<3> facets, Eigen::Index vertices);
template Boundary<4> index_boundary<4>(Simplices<4> facets, Eigen::Index vertices);

}  // namespace pent::viewer
