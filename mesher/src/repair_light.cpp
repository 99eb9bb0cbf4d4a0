#include "cgal_mesh.h"
#include "repair_steps.h"
#include "self_intersections.h"

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <algorithm>
#include <array>
#include <map>
#include <vector>

namespace pent::mesher {

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;

// Corners sorted, and whether sorting them was an even permutation.
struct Key {
    std::array<std::uint32_t, 3> corners{};
    bool is_even = true;
};

Key key_of(const Simplices<3>& triangles, Eigen::Index t) {
    Key key{{triangles(0, t), triangles(1, t), triangles(2, t)}};
    for (const int i : {0, 1, 0}) {
        if (key.corners[i] > key.corners[i + 1]) {
            std::swap(key.corners[i], key.corners[i + 1]);
            key.is_even = !key.is_even;
        }
    }
    return key;
}

// A manifold mesh: triangles are turned over to agree with their neighbors, and the surface is cut
// open along edges where more than two meet or no orientation agrees; then borders that coincide
// are stitched where that leaves it a manifold.
CgalMesh manifold_of(const Surface& surface) {
    std::vector<Kernel::Point_3> points;
    std::vector<std::vector<std::size_t>> polygons;
    for (const auto& p : surface.points.colwise()) {
        points.emplace_back(p[0], p[1], p[2]);
    }
    for (const auto& t : surface.triangles.colwise()) {
        polygons.push_back({t[0], t[1], t[2]});
    }
    pmp::orient_polygon_soup(points, polygons);
    CgalMesh mesh;
    pmp::polygon_soup_to_polygon_mesh(points, polygons, mesh);
    pmp::stitch_borders(mesh);
    return mesh;
}

void fill_holes(CgalMesh& mesh) {
    std::vector<CgalMesh::Halfedge_index> cycles;
    pmp::extract_boundary_cycles(mesh, std::back_inserter(cycles));
    for (const CgalMesh::Halfedge_index cycle : cycles) {
        std::vector<CgalMesh::Face_index> patch;
        pmp::triangulate_hole(mesh, cycle, std::back_inserter(patch));
    }
}

}  // namespace

Surface drop_useless_triangles(const Surface& surface) {
    // Even minus odd copies of each triangle that is not flat.
    std::map<std::array<std::uint32_t, 3>, int> balance;
    for (Eigen::Index t = 0; t < surface.triangle_count(); ++t) {
        if (!is_degenerate(surface, t)) {
            const Key key = key_of(surface.triangles, t);
            balance[key.corners] += key.is_even ? 1 : -1;
        }
    }
    // Walls go, both of their sides; but where all triangles come in pairs, the surface as a whole
    // is two-sided, as renderers like it, and one side stays.
    const bool is_two_sided = std::all_of(balance.begin(), balance.end(),
                                          [](const auto& entry) { return entry.second == 0; });
    std::vector<std::uint32_t> corners;
    for (Eigen::Index t = 0; t < surface.triangle_count(); ++t) {
        const Key key = key_of(surface.triangles, t);
        const auto place = balance.find(key.corners);
        if (place != balance.end()
            && (is_two_sided || (key.is_even ? place->second > 0 : place->second < 0))) {
            for (int i = 0; i < 3; ++i) {
                corners.push_back(surface.triangles(i, t));
            }
            balance.erase(place);
        }
    }
    const Eigen::Map<const Simplices<3>> kept(corners.data(), 3,
                                              static_cast<Eigen::Index>(corners.size() / 3));
    return weld(surface.points, kept).surface;
}

Surface close_holes(const Surface& surface) {
    CgalMesh mesh = manifold_of(surface);
    fill_holes(mesh);
    const Surface closed = from_cgal(mesh);
    return weld(closed.points, closed.triangles).surface;
}

Surface cut_self_intersections(const Surface& surface) {
    CgalMesh mesh = manifold_of(surface);
    if (CGAL::is_closed(mesh)) {
        pmp::experimental::remove_self_intersections(mesh, CGAL::parameters::preserve_genus(false));
        fill_holes(mesh);
    }
    const Surface mended = from_cgal(mesh);
    return weld(mended.points, mended.triangles).surface;
}

}  // namespace pent::mesher
