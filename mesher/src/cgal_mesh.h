#pragma once

// The one place where our surfaces become CGAL's and back. Heavy: include it in few files.

#include <pent/mesher/surface.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

namespace pent::mesher {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalMesh = CGAL::Surface_mesh<Kernel::Point_3>;

/// @param surface  Manifold and oriented.
[[nodiscard]] inline CgalMesh to_cgal(const Surface& surface) {
    CgalMesh mesh;
    for (const auto& p : surface.points.colwise()) {
        mesh.add_vertex(Kernel::Point_3(p[0], p[1], p[2]));
    }
    for (const auto& t : surface.triangles.colwise()) {
        mesh.add_face(CgalMesh::Vertex_index(t[0]), CgalMesh::Vertex_index(t[1]),
                      CgalMesh::Vertex_index(t[2]));
    }
    return mesh;
}

/// @param mesh  Triangles only. Collects its garbage, so that indices are consecutive.
[[nodiscard]] inline Surface from_cgal(CgalMesh& mesh) {
    mesh.collect_garbage();
    Surface surface;
    surface.points.resize(3, static_cast<Eigen::Index>(mesh.number_of_vertices()));
    for (const CgalMesh::Vertex_index v : mesh.vertices()) {
        const Kernel::Point_3& p = mesh.point(v);
        surface.points.col(v.idx()) << p.x(), p.y(), p.z();
    }
    surface.triangles.resize(3, static_cast<Eigen::Index>(mesh.number_of_faces()));
    for (const CgalMesh::Face_index f : mesh.faces()) {
        int i = 0;
        for (const CgalMesh::Vertex_index v : mesh.vertices_around_face(mesh.halfedge(f))) {
            surface.triangles(i++, f.idx()) = v.idx();
        }
    }
    return surface;
}

}  // namespace pent::mesher
