#include "cgal_mesh.h"
#include "generators.h"
#include "isolated.h"

#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_polyhedron_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polyhedral_mesh_domain_with_features_3.h>
#include <CGAL/make_mesh_3.h>
#include <map>
#include <utility>

namespace pent::mesher {

namespace {

using Domain = CGAL::Polyhedral_mesh_domain_with_features_3<Kernel, CgalMesh>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::
    Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index, Domain::Curve_index>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

constexpr double kSharpEdge = 60;        // degrees between normals: kept as an edge
constexpr double kSliverBound = 10;      // degrees: no dihedral angle below it is aimed at
constexpr double kFacetDistance = 0.05;  // of the edge length, from facets to the surface

double mean_edge_of(const Surface& surface) {
    double sum = 0;
    for (const auto& t : surface.triangles.colwise()) {
        for (int i = 0; i < 3; ++i) {
            sum += (surface.points.col(t[i]) - surface.points.col(t[(i + 1) % 3])).norm();
        }
    }
    return sum / static_cast<double>(3 * surface.triangle_count());
}

Criteria criteria_for(double edge_length) {
    namespace p = CGAL::parameters;
    // Bounds for radii of circumspheres; with these the edges come out about as long as wanted.
    return Criteria(p::edge_size = 1.2 * edge_length, p::facet_angle = 25,
                    p::facet_size = edge_length, p::facet_distance = kFacetDistance * edge_length,
                    p::cell_radius_edge_ratio = 2, p::cell_size = edge_length);
}

void append(const Complex& complex, SimplexMesh<3>& mesh) {
    const Triangulation& triangulation = complex.triangulation();
    std::map<Triangulation::Vertex_handle, std::uint32_t> names;
    std::vector<Eigen::Vector3d> points;
    std::vector<std::uint32_t> corners;
    const auto first = static_cast<std::uint32_t>(mesh.vertex_count());
    for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end();
         ++cell) {
        for (int i = 0; i < 4; ++i) {
            const auto next = static_cast<std::uint32_t>(first + points.size());
            const auto [place, is_new] = names.try_emplace(cell->vertex(i), next);
            if (is_new) {
                const auto p = triangulation.point(cell->vertex(i)).point();
                points.emplace_back(p.x(), p.y(), p.z());
            }
            corners.push_back(place->second);
        }
    }
    mesh.positions.conservativeResize(3, first + static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        mesh.positions.col(first + static_cast<Eigen::Index>(i)) = points[i];
    }
    const Eigen::Index cells = mesh.cell_count();
    mesh.cells.conservativeResize(4, cells + static_cast<Eigen::Index>(corners.size() / 4));
    std::copy(corners.begin(), corners.end(), mesh.cells.col(cells).data());
}

void fill_body(const Surface& body, double edge_length, SimplexMesh<3>& mesh) {
    CgalMesh polyhedron = to_cgal(body);
    CGAL::Random random(0);
    Domain domain(polyhedron, &random);
    domain.detect_features(kSharpEdge);
    namespace p = CGAL::parameters;
    // No time limits: they would make the result depend on the speed of the machine.
    const auto complex =
        CGAL::make_mesh_3<Complex>(domain, criteria_for(edge_length),
                                   p::perturb(p::time_limit = 0, p::sliver_bound = kSliverBound),
                                   p::exude(p::time_limit = 0, p::sliver_bound = kSliverBound));
    append(complex, mesh);
}

}  // namespace

Tetrahedra fill_with_mesh3(const Surface& surface, const TetrahedraOptions& options) {
    const double edge_length =
        options.edge_length > 0 ? options.edge_length : mean_edge_of(surface);
    Tetrahedra tetrahedra;
    tetrahedra.generator = "CGAL Mesh_3";
    // It crashes on some surfaces, runs away on others, and breaks its own assumptions on some
    // more.
    Pieces<4> pieces = run_isolated<4>("Mesh_3", options.limits, [&]() -> Pieces<4> {
        SimplexMesh<3> mesh;
        for (const Surface& body : bodies_of(surface)) {
            fill_body(body, edge_length, mesh);
        }
        return {std::move(mesh.positions), std::move(mesh.cells)};
    });
    tetrahedra.mesh.positions = std::move(pieces.points);
    tetrahedra.mesh.cells = std::move(pieces.cells);
    return tetrahedra;
}

}  // namespace pent::mesher
