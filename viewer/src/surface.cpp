#include "pent/viewer/surface.h"

#include <pent/parallel.h>
#include <pent/surface_measures.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace pent::viewer {

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// The vertex of the mesh that surface vertex v lies on, or kNone.
std::uint32_t mesh_vertex(const Surface& surface, Eigen::Index v) {
    if (surface.weights[v] == 0.0) {
        return surface.ends(0, v);
    }
    return surface.weights[v] == 1.0 ? surface.ends(1, v) : kNone;
}

using Edge = std::pair<std::uint32_t, std::uint32_t>;

// The triangles that keep three different corners, with corners renamed by `target`.
std::vector<Eigen::Index> kept_triangles(const Surface& surface,
                                         const std::vector<std::uint32_t>& target) {
    std::vector<Eigen::Index> kept;
    for (Eigen::Index t = 0; t < surface.triangle_count(); ++t) {
        const std::uint32_t a = target[surface.triangles(0, t)];
        const std::uint32_t b = target[surface.triangles(1, t)];
        const std::uint32_t c = target[surface.triangles(2, t)];
        if (a != b && b != c && c != a) {
            kept.push_back(t);
        }
    }
    return kept;
}

// Edges with a merged end at which, after merging, other than two opposite triangles meet.
std::vector<Edge> pinched_edges(const Surface& surface,
                                const std::vector<std::uint32_t>& target,
                                const std::vector<std::uint32_t>& merged_into,
                                const std::vector<Eigen::Index>& kept) {
    std::vector<Edge> directed;
    for (const Eigen::Index t : kept) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t from = surface.triangles(k, t);
            const std::uint32_t to = surface.triangles((k + 1) % 3, t);
            if (merged_into[from] != kNone || merged_into[to] != kNone) {
                directed.emplace_back(target[from], target[to]);
            }
        }
    }
    std::sort(directed.begin(), directed.end());
    std::vector<Edge> pinched;
    for (std::size_t i = 1; i < directed.size(); ++i) {
        if (directed[i] == directed[i - 1]) {
            pinched.push_back(directed[i]);
        }
    }
    return pinched;
}

// Keeps only the given triangles, renamed, and the vertices they use, in their old order.
Surface rebuilt(const Surface& surface,
                const std::vector<std::uint32_t>& target,
                const std::vector<Eigen::Index>& kept) {
    std::vector<std::uint32_t> number(target.size(), kNone);
    for (const Eigen::Index t : kept) {
        for (int k = 0; k < 3; ++k) {
            number[target[surface.triangles(k, t)]] = 0;
        }
    }
    std::uint32_t vertices = 0;
    for (std::uint32_t& n : number) {
        if (n != kNone) {
            n = vertices++;
        }
    }
    Surface result;
    result.positions.resize(3, vertices);
    result.ends.resize(2, vertices);
    result.weights.resize(vertices);
    for (std::size_t v = 0; v < number.size(); ++v) {
        if (number[v] != kNone) {
            const auto from = static_cast<Eigen::Index>(v);
            result.positions.col(number[v]) = surface.positions.col(from);
            result.ends.col(number[v]) = surface.ends.col(from);
            result.weights[number[v]] = surface.weights[from];
        }
    }
    result.triangles.resize(3, static_cast<Eigen::Index>(kept.size()));
    result.facets.reserve(kept.size());
    for (std::size_t t = 0; t < kept.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            result.triangles(k, static_cast<Eigen::Index>(t)) =
                number[target[surface.triangles(k, kept[t])]];
        }
        result.facets.push_back(surface.facets[static_cast<std::size_t>(kept[t])]);
    }
    return result;
}

}  // namespace

Eigen::VectorXd interpolate(const Surface& surface, const Eigen::VectorXd& values) {
    Eigen::VectorXd result(surface.vertex_count());
    parallel_for(surface.vertex_count(), kLightChunk, [&](Eigen::Index v) {
        const double t = surface.weights[v];
        result[v] = (1.0 - t) * values[surface.ends(0, v)] + t * values[surface.ends(1, v)];
    });
    return result;
}

double enclosed_volume(const TriangleMesh& surface) {
    return pent::enclosed_volume(surface.positions, surface.triangles);
}

double area(const TriangleMesh& surface) {
    return triangle_area(surface.positions, surface.triangles);
}

Eigen::AlignedBox3d bounding_box(const TriangleMesh& surface) {
    Eigen::AlignedBox3d box;
    if (surface.vertex_count() > 0) {
        box.min() = surface.positions.rowwise().minCoeff();
        box.max() = surface.positions.rowwise().maxCoeff();
    }
    return box;
}

Surface merge_coincident(const Surface& surface) {
    const auto vertices = static_cast<std::size_t>(surface.vertex_count());
    std::vector<std::uint32_t> merged_into(vertices);  // the mesh vertex, or kNone to stay apart
    std::uint32_t highest = 0;
    bool any = false;
    for (std::size_t v = 0; v < vertices; ++v) {
        merged_into[v] = mesh_vertex(surface, static_cast<Eigen::Index>(v));
        if (merged_into[v] != kNone) {
            highest = std::max(highest, merged_into[v]);
            any = true;
        }
    }
    if (!any) {
        return surface;
    }
    // Each round sets at least one mesh vertex apart, so this ends; usually after the first round.
    for (;;) {
        std::vector<std::uint32_t> first(static_cast<std::size_t>(highest) + 1, kNone);
        std::vector<std::uint32_t> target(vertices);
        for (std::size_t v = 0; v < vertices; ++v) {
            target[v] = static_cast<std::uint32_t>(v);
            if (merged_into[v] != kNone) {
                std::uint32_t& representative = first[merged_into[v]];
                representative = representative == kNone ? target[v] : representative;
                target[v] = representative;
            }
        }
        const std::vector<Eigen::Index> kept = kept_triangles(surface, target);
        const std::vector<Edge> pinched = pinched_edges(surface, target, merged_into, kept);
        if (pinched.empty()) {
            return rebuilt(surface, target, kept);
        }
        std::vector<bool> is_apart(static_cast<std::size_t>(highest) + 1, false);
        for (const Edge& edge : pinched) {
            for (const std::uint32_t end : {edge.first, edge.second}) {
                if (merged_into[end] != kNone) {
                    is_apart[merged_into[end]] = true;
                }
            }
        }
        for (std::uint32_t& vertex : merged_into) {
            vertex = vertex != kNone && is_apart[vertex] ? kNone : vertex;
        }
    }
}

}  // namespace pent::viewer
