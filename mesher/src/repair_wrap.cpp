#include "cgal_mesh.h"
#include "repair_steps.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/alpha_wrap_3.h>
#include <array>
#include <vector>

namespace pent::mesher {

namespace {

using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

std::vector<Kernel::Point_3> points_of(const Surface& surface) {
    std::vector<Kernel::Point_3> points;
    for (const auto& p : surface.points.colwise()) {
        points.emplace_back(p[0], p[1], p[2]);
    }
    return points;
}

Triangles triangles_of(const Surface& surface) {
    const std::vector<Kernel::Point_3> points = points_of(surface);
    Triangles triangles;
    for (const auto& t : surface.triangles.colwise()) {
        triangles.emplace_back(points[t[0]], points[t[1]], points[t[2]]);
    }
    return triangles;
}

}  // namespace

Surface wrap(const Surface& surface, double alpha, double offset) {
    std::vector<std::array<std::size_t, 3>> faces;
    for (const auto& t : surface.triangles.colwise()) {
        faces.push_back({t[0], t[1], t[2]});
    }
    CgalMesh mesh;
    CGAL::alpha_wrap_3(points_of(surface), faces, alpha, offset, mesh);
    return from_cgal(mesh);
}

double distance_between(const Surface& from, const Surface& to) {
    const Triangles triangles = triangles_of(to);
    const Tree tree(triangles.begin(), triangles.end());
    double largest = 0;
    const auto sample = [&](const Eigen::Vector3d& p) {
        largest = std::max(largest, tree.squared_distance({p[0], p[1], p[2]}));
    };
    for (const auto& t : from.triangles.colwise()) {
        const Eigen::Vector3d a = from.points.col(t[0]);
        const Eigen::Vector3d b = from.points.col(t[1]);
        const Eigen::Vector3d c = from.points.col(t[2]);
        sample(a);
        sample((a + b) / 2);
        sample((b + c) / 2);
        sample((c + a) / 2);
        sample((a + b + c) / 3);
    }
    return std::sqrt(largest);
}

}  // namespace pent::mesher
