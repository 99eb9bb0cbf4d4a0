#include "union_find.h"

#include <pent/facets.h>
#include <pent/mesher/links.h>

#include <algorithm>
#include <span>
#include <vector>

namespace pent::mesher {

namespace {

// The facets around each vertex, one after the other.
struct Stars {
    std::vector<std::size_t> first;     // one a vertex, and one behind the last
    std::vector<std::uint32_t> facets;  // those of vertex v from first[v] to first[v + 1]
};

template <int Dim>
Stars stars_of(const Simplices<Dim>& facets, Eigen::Index vertices) {
    Stars stars;
    stars.first.assign(vertices + 1, 0);
    for (const std::uint32_t corner : facets.reshaped()) {
        ++stars.first[corner + 1];
    }
    for (Eigen::Index v = 0; v < vertices; ++v) {
        stars.first[v + 1] += stars.first[v];
    }
    stars.facets.resize(stars.first.back());
    std::vector<std::size_t> next(stars.first.begin(), stars.first.end() - 1);
    for (Eigen::Index facet = 0; facet < facets.cols(); ++facet) {
        for (int i = 0; i < Dim; ++i) {
            stars.facets[next[facets(i, facet)]++] = static_cast<std::uint32_t>(facet);
        }
    }
    return stars;
}

// The closed link of dimension Dim - 2 is connected and has the sphere's Euler characteristic. Its
// ridges are shared by two facets each, so that edges number Dim / 2 per triangle.
template <int Dim>
bool is_sphere(const Simplices<Dim>& facets,
               std::span<const std::uint32_t> star,
               std::uint32_t vertex) {
    std::vector<std::uint32_t> corners;  // Dim - 1 a facet of the link
    for (const std::uint32_t facet : star) {
        for (int i = 0; i < Dim; ++i) {
            if (facets(i, facet) != vertex) {
                corners.push_back(facets(i, facet));
            }
        }
    }
    std::vector<std::uint32_t> names = corners;
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    if constexpr (Dim == 2) {
        return names.size() == 2;
    }
    UnionFind parts(names.size());
    std::size_t joins = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const auto name_of = [&](std::uint32_t corner) {
            return static_cast<std::uint32_t>(std::lower_bound(names.begin(), names.end(), corner)
                                              - names.begin());
        };
        const std::uint32_t a = name_of(corners[i]);
        const std::uint32_t b = name_of(corners[i - i % (Dim - 1)]);
        joins += parts.find(a) != parts.find(b) ? 1 : 0;
        parts.join(a, b);
    }
    const bool is_connected = joins + 1 == names.size();
    const auto V = static_cast<std::int64_t>(names.size());
    const auto F = static_cast<std::int64_t>(star.size());
    return is_connected && (Dim == 3 ? V == F : 2 * V - F == 4);  // V - 3/2 F + F = 2
}

}  // namespace

template <int Dim>
LinkReport check_links(const SimplexMesh<Dim>& mesh) {
    const Simplices<Dim> facets = match_facets<Dim>(mesh.cells, mesh.vertex_count()).boundary;
    const Stars stars = stars_of<Dim>(facets, mesh.vertex_count());
    std::vector<bool> is_used(mesh.vertex_count(), false);
    for (const std::uint32_t corner : mesh.cells.reshaped()) {
        is_used[corner] = true;
    }
    LinkReport report;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        report.unused_vertices += is_used[v] ? 0 : 1;
        const std::span star(stars.facets.data() + stars.first[v],
                             stars.first[v + 1] - stars.first[v]);
        if (star.empty()) {
            continue;
        }
        ++report.boundary_vertices;
        if (!is_sphere<Dim>(facets, star, v)) {
            report.first_faulty = report.faulty == 0 ? v : report.first_faulty;
            ++report.faulty;
        }
    }
    return report;
}

template LinkReport check_links<2>(const SimplexMesh<2>&);
template LinkReport check_links<3>(const SimplexMesh<3>&);
template LinkReport check_links<4>(const SimplexMesh<4>&);

}  // namespace pent::mesher
