#include "sound_base.h"

#include <pent/error.h>
#include <pent/facets.h>
#include <pent/formatted.h>
#include <pent/mesher/links.h>
#include <pent/mesher/prove.h>

#include <algorithm>
#include <array>
#include <vector>

namespace pent::mesher {

namespace {

constexpr const char* kRemedy =
    "; join them by a triangle that both have, or give each part points of its own and move them"
    " apart";

std::string place_of(const SimplexMesh<3>& mesh, Eigen::Index vertex) {
    const Eigen::Vector3d x = mesh.positions.col(vertex);
    return formatted("(%.9g, %.9g, %.9g)", x[0], x[1], x[2]);
}

// Edges where more than two triangles of the boundary meet, by their ends.
std::vector<std::array<std::uint32_t, 2>> crowded_edges(const SimplexMesh<3>& mesh) {
    std::vector<std::array<std::uint32_t, 2>> edges;
    const FacetMatch<3> match = match_facets<3>(mesh.cells, mesh.vertex_count());
    for (const auto& triangle : match.boundary.colwise()) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t from = triangle[k];
            const std::uint32_t to = triangle[(k + 1) % 3];
            edges.push_back({std::min(from, to), std::max(from, to)});
        }
    }
    std::sort(edges.begin(), edges.end());
    std::vector<std::array<std::uint32_t, 2>> crowded;
    for (auto begin = edges.begin(); begin != edges.end();) {
        const auto end = std::upper_bound(begin, edges.end(), *begin);
        if (end - begin > 2) {
            crowded.push_back(*begin);
        }
        begin = end;
    }
    return crowded;
}

std::string times(std::int64_t count) {
    return count == 1 ? "once" : std::to_string(count) + " times";
}

}  // namespace

void require_sound_base(const SimplexMesh<3>& mesh, const std::string& name) {
    if (const Proof proof = prove(mesh); !proof.holds()) {
        const auto edges = crowded_edges(mesh);
        if (proof.faulty_facets == 0 && !edges.empty()) {
            throw Error(name + ": parts touch in an edge alone, "
                        + times(static_cast<std::int64_t>(edges.size())) + ", first from "
                        + place_of(mesh, edges.front()[0]) + " to "
                        + place_of(mesh, edges.front()[1]) + kRemedy);
        }
        throw Error(name + ": the tetrahedra do not fit together: " + describe_faults(proof, 3));
    }
    if (const LinkReport links = check_links(mesh); links.faulty > 0) {
        throw Error(name + ": parts touch in a point alone, " + times(links.faulty) + ", first at "
                    + place_of(mesh, links.first_faulty) + kRemedy);
    }
}

}  // namespace pent::mesher
