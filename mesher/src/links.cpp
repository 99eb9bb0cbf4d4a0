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

// The link of a vertex: of each facet around it the other Dim - 1 corners, as vertices of the link,
// which are numbered from 0.
struct Link {
    std::vector<std::uint32_t> corners;
    std::uint32_t vertices = 0;
};

template <int Dim>
Link link_of(const Simplices<Dim>& facets,
             std::span<const std::uint32_t> star,
             std::uint32_t vertex) {
    Link link;
    for (const std::uint32_t facet : star) {
        for (int i = 0; i < Dim; ++i) {
            if (facets(i, facet) != vertex) {
                link.corners.push_back(facets(i, facet));
            }
        }
    }
    std::vector<std::uint32_t> used = link.corners;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (std::uint32_t& corner : link.corners) {
        corner = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), corner)
                                            - used.begin());
    }
    link.vertices = static_cast<std::uint32_t>(used.size());
    return link;
}

template <int Dim>
bool is_connected(const Link& link) {
    UnionFind parts(link.vertices);
    std::uint32_t joins = 0;
    for (std::size_t i = 0; i < link.corners.size(); ++i) {
        const std::uint32_t a = link.corners[i];
        const std::uint32_t b = link.corners[i - i % (Dim - 1)];
        joins += parts.find(a) != parts.find(b) ? 1 : 0;
        parts.join(a, b);
    }
    return joins + 1 == link.vertices;
}

// Whether each edge is shared by two triangles, and the triangles around each vertex are one cycle,
// not several that touch there. Corners of triangles at one vertex are joined across the edges that
// the triangles share, so that each cycle becomes one set: there are as many sets as vertices then.
bool is_surface(const Link& link) {
    struct Side {
        std::uint32_t low;
        std::uint32_t high;
        std::uint32_t at_low;  // places in link.corners
        std::uint32_t at_high;
    };
    std::vector<Side> sides;
    for (std::uint32_t i = 0; i < link.corners.size(); ++i) {
        const std::uint32_t next = i % 3 == 2 ? i - 2 : i + 1;
        const bool is_low = link.corners[i] < link.corners[next];
        const std::uint32_t low = is_low ? i : next;
        const std::uint32_t high = is_low ? next : i;
        sides.push_back({link.corners[low], link.corners[high], low, high});
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return a.low != b.low ? a.low < b.low : a.high < b.high;
    });
    UnionFind parts(link.corners.size());
    auto cycles = static_cast<std::uint32_t>(link.corners.size());
    const auto join = [&](std::uint32_t a, std::uint32_t b) {
        cycles -= parts.find(a) != parts.find(b) ? 1 : 0;
        parts.join(a, b);
    };
    const auto are_one = [&](std::size_t i, std::size_t j) {
        return j < sides.size() && sides[i].low == sides[j].low && sides[i].high == sides[j].high;
    };
    for (std::size_t i = 0; i < sides.size(); i += 2) {
        if (!are_one(i, i + 1) || are_one(i, i + 2)) {
            return false;  // shared by another number of triangles than two
        }
        join(sides[i].at_low, sides[i + 1].at_low);
        join(sides[i].at_high, sides[i + 1].at_high);
    }
    return cycles == link.vertices;
}

// Whether a link, which is closed and of dimension Dim - 2, is connected and has the Euler
// characteristic of a sphere. As two triangles share each edge there are 3/2 edges to a triangle.
template <int Dim>
bool is_sphere(const Link& link) {
    const auto V = static_cast<std::int64_t>(link.vertices);
    const auto F = static_cast<std::int64_t>(link.corners.size()) / (Dim - 1);
    if constexpr (Dim == 2) {
        return V == 2;
    } else if constexpr (Dim == 3) {
        return V == F && is_connected<Dim>(link);
    } else {
        return 2 * V - F == 4 && is_connected<Dim>(link) && is_surface(link);  // V - 3/2 F + F = 2
    }
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
    report.is_faulty.assign(mesh.vertex_count(), false);
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        report.unused_vertices += is_used[v] ? 0 : 1;
        const std::span star(stars.facets.data() + stars.first[v],
                             stars.first[v + 1] - stars.first[v]);
        if (star.empty()) {
            continue;
        }
        ++report.boundary_vertices;
        if (!is_sphere<Dim>(link_of<Dim>(facets, star, v))) {
            report.first_faulty = report.faulty == 0 ? v : report.first_faulty;
            report.is_faulty[v] = true;
            ++report.faulty;
        }
    }
    return report;
}

template LinkReport check_links<2>(const SimplexMesh<2>&);
template LinkReport check_links<3>(const SimplexMesh<3>&);
template LinkReport check_links<4>(const SimplexMesh<4>&);

}  // namespace pent::mesher
