#include "cgal_mesh.h"
#include "extract.h"
#include "half_edges.h"
#include "repair_steps.h"
#include "union_find.h"

#include <pent/mesher/surface_check.h>

#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace pent::mesher {

namespace {

// Parts of a surface connected through edges; `parts` also joins those that cross.
std::map<std::uint32_t, std::vector<std::uint32_t>> members_of(UnionFind& parts,
                                                               Eigen::Index triangles) {
    std::map<std::uint32_t, std::vector<std::uint32_t>> members;
    for (std::uint32_t t = 0; t < triangles; ++t) {
        members[parts.find(t)].push_back(t);
    }
    return members;
}

UnionFind components_of(const Surface& surface) {
    UnionFind parts(surface.triangle_count());
    for_each_edge(sorted_half_edges(surface.triangles), [&](auto first, auto last) {
        for (auto other = std::next(first); other != last; ++other) {
            parts.join(first->triangle, other->triangle);
        }
    });
    return parts;
}

// Positive volume; which way its triangles turned says nothing, as it crosses others.
CgalMesh body_of(const Surface& component) {
    Surface body = component;
    if (enclosed_volume(body) < 0) {
        body.triangles.row(1).swap(body.triangles.row(2));
    }
    return to_cgal(body);
}

void append(Surface& surface, const Surface& part) {
    const Eigen::Index points = surface.point_count();
    const Eigen::Index triangles = surface.triangle_count();
    surface.points.conservativeResize(3, points + part.point_count());
    surface.points.rightCols(part.point_count()) = part.points;
    surface.triangles.conservativeResize(3, triangles + part.triangle_count());
    surface.triangles.rightCols(part.triangle_count()) =
        part.triangles.array() + static_cast<std::uint32_t>(points);
}

// The components of one group, united one after the other; none if the union is not a manifold.
std::optional<CgalMesh> united(const Surface& surface,
                               const std::vector<std::vector<std::uint32_t>>& group) {
    namespace pmp = CGAL::Polygon_mesh_processing;
    CgalMesh whole = body_of(extract(surface, group.front()));
    for (std::size_t i = 1; i < group.size(); ++i) {
        CgalMesh next = body_of(extract(surface, group[i]));
        if (!pmp::corefine_and_compute_union(whole, next, whole,
                                             CGAL::parameters::throw_on_self_intersection(true))) {
            return std::nullopt;
        }
    }
    return whole;
}

}  // namespace

Surface unite_crossing_components(const Surface& surface) {
    UnionFind parts = components_of(surface);
    UnionFind groups = parts;
    for (const auto& [a, b] : self_intersections(surface)) {
        if (parts.find(a) == parts.find(b)) {
            return surface;
        }
        groups.join(a, b);
    }
    std::map<std::uint32_t, std::vector<std::vector<std::uint32_t>>> components_in;
    for (auto& [root, triangles] : members_of(parts, surface.triangle_count())) {
        components_in[groups.find(root)].push_back(std::move(triangles));
    }
    Surface result;
    for (const auto& [root, group] : components_in) {
        if (group.size() == 1) {
            append(result, extract(surface, group.front()));
        } else {
            std::optional<CgalMesh> whole = united(surface, group);
            if (!whole) {
                return surface;
            }
            append(result, from_cgal(*whole));
        }
    }
    return weld(result.points, result.triangles).surface;
}

}  // namespace pent::mesher
