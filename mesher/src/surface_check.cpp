#include "half_edges.h"
#include "self_intersections.h"
#include "union_find.h"

#include <pent/formatted.h>
#include <pent/mesher/surface_check.h>

#include <cinttypes>

namespace pent::mesher {

namespace {

using EdgeIterator = std::vector<HalfEdge>::const_iterator;

void add(Defect& defect, const Surface& surface, std::int64_t triangle) {
    ++defect.count;
    if (defect.first_triangle < 0 || triangle < defect.first_triangle) {
        defect.first_triangle = triangle;
        defect.place = surface.points.col(surface.triangles(0, triangle));
    }
}

void find_duplicates(const Surface& surface, SurfaceReport& report) {
    std::vector<std::array<std::uint32_t, 4>> sorted(surface.triangle_count());
    for (Eigen::Index t = 0; t < surface.triangle_count(); ++t) {
        std::array<std::uint32_t, 4>& key = sorted[t];
        key = {surface.triangles(0, t), surface.triangles(1, t), surface.triangles(2, t),
               static_cast<std::uint32_t>(t)};
        std::sort(key.begin(), key.begin() + 3);
    }
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t i = 1; i < sorted.size(); ++i) {
        if (std::equal(sorted[i].begin(), sorted[i].begin() + 3, sorted[i - 1].begin())) {
            add(report.duplicate, surface, sorted[i][3]);
        }
    }
}

void find_edge_defects(const Surface& surface,
                       const std::vector<HalfEdge>& half_edges,
                       SurfaceReport& report) {
    for_each_edge(half_edges, [&](EdgeIterator first, EdgeIterator last) {
        if (first->low == first->high) {
            return;  // a triangle with a corner twice: counted as degenerate
        }
        const auto triangles = last - first;
        if (triangles == 1) {
            add(report.border_edges, surface, first->triangle);
        } else if (triangles > 2) {
            add(report.non_manifold_edges, surface, first->triangle);
        } else if (first->is_forward == std::next(first)->is_forward) {
            add(report.misoriented_edges, surface, first->triangle);
        }
    });
}

// Corner of a triangle at one end of a half-edge; corners are numbered 3 * triangle + place.
std::uint32_t corner_at(const Simplices<3>& triangles,
                        const HalfEdge& half_edge,
                        std::uint32_t point) {
    const std::uint32_t next = (half_edge.side + 1U) % 3U;
    const bool is_start = triangles(half_edge.side, half_edge.triangle) == point;
    return 3 * half_edge.triangle + (is_start ? half_edge.side : next);
}

// Triangles around a point fall into fans, joined through edges. A second fan at a point means
// that the surface touches itself there.
void find_fans(const Surface& surface,
               const std::vector<HalfEdge>& half_edges,
               SurfaceReport& report) {
    UnionFind fans(surface.triangles.size());
    UnionFind parts(surface.triangle_count());
    for_each_edge(half_edges, [&](EdgeIterator first, EdgeIterator last) {
        for (EdgeIterator other = std::next(first); other != last; ++other) {
            parts.join(first->triangle, other->triangle);
            for (const std::uint32_t point : {first->low, first->high}) {
                fans.join(corner_at(surface.triangles, *first, point),
                          corner_at(surface.triangles, *other, point));
            }
        }
    });
    std::vector<std::int64_t> first_fan(surface.point_count(), -1);
    for (std::uint32_t corner = 0; corner < surface.triangles.size(); ++corner) {
        if (corner % 3 == 0 && parts.find(corner / 3) == corner / 3) {
            ++report.components;
        }
        if (fans.find(corner) != corner) {
            continue;
        }
        std::int64_t& fan = first_fan[surface.triangles.reshaped()[corner]];
        if (fan >= 0) {
            add(report.non_manifold_points, surface, corner / 3);
        }
        fan = corner;
    }
}

void add_text(std::string& text,
              const Defect& defect,
              const std::string& singular,
              const std::string& plural) {
    if (defect.count == 0) {
        return;
    }
    text +=
        (text.empty() ? "" : "; ") + std::to_string(defect.count) + " "
        + (defect.count == 1 ? singular : plural)
        + formatted(" (first at triangle %" PRId64 ", near (%.6g, %.6g, %.6g))",
                    defect.first_triangle, defect.place.x(), defect.place.y(), defect.place.z());
}

}  // namespace

bool SurfaceReport::is_clean() const {
    return degenerate.count == 0 && duplicate.count == 0 && border_edges.count == 0
           && non_manifold_edges.count == 0 && non_manifold_points.count == 0
           && self_intersections.count == 0;
}

SurfaceReport check_surface(const Surface& surface) {
    SurfaceReport report;
    report.points = surface.point_count();
    report.triangles = surface.triangle_count();
    for (Eigen::Index t = 0; t < surface.triangle_count(); ++t) {
        if (is_degenerate(surface, t)) {
            add(report.degenerate, surface, t);
        }
    }
    find_duplicates(surface, report);
    const std::vector<HalfEdge> half_edges = sorted_half_edges(surface.triangles);
    find_edge_defects(surface, half_edges, report);
    find_fans(surface, half_edges, report);
    for (const std::array<std::uint32_t, 2>& pair : self_intersections(surface)) {
        add(report.self_intersections, surface, pair[0]);
    }
    return report;
}

std::string describe(const SurfaceReport& report) {
    std::string text;
    add_text(text, report.degenerate, "degenerate triangle", "degenerate triangles");
    add_text(text, report.duplicate, "duplicate triangle", "duplicate triangles");
    add_text(text, report.border_edges, "border edge", "border edges");
    add_text(text, report.non_manifold_edges, "non-manifold edge", "non-manifold edges");
    add_text(text, report.non_manifold_points, "non-manifold point", "non-manifold points");
    add_text(text, report.misoriented_edges, "misoriented edge", "misoriented edges");
    add_text(text, report.self_intersections, "self-intersecting pair of triangles",
             "self-intersecting pairs of triangles");
    return text.empty() ? "closed, manifold, free of self-intersections" : text;
}

}  // namespace pent::mesher
