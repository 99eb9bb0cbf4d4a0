#include "base_mesh.h"
#include "body_steps.h"
#include "check_request.h"
#include "solid_input.h"

#include <pent/error.h>
#include <pent/facets.h>

#include <cmath>
#include <utility>

namespace pent::mesher {

namespace {

// Where the surface of a sphere was resampled or subdivided, vertices are on the flat triangles
// that it had before and not on the sphere, and edges between them would stay straight.
void require_vertices_on_sphere(double radius, const SimplexMesh<3>& mesh) {
    constexpr double kRounding = 1e-9;
    const Simplices<3> boundary = match_facets<3>(mesh.cells, mesh.vertex_count()).boundary;
    for (const std::uint32_t v : boundary.reshaped()) {
        if (std::abs(mesh.positions.col(v).norm() - radius) > kRounding * radius) {
            throw Error(
                "the sphere: its surface was made anew, of points beside it, and cannot be"
                " curved; leave out triangles, edge length, Mesh_3 and subdivision of the"
                " surface, and ask for a sphere of more triangles");
        }
    }
}

// The tetrahedra are the body.
Body<3> finish_solid(SimplexMesh<3> mesh,
                     MeshExtras<3> extras,
                     const BodyRequest& request,
                     BodyReport report,
                     StageClock& clock) {
    describe_base<3>(mesh, report);
    announce(request, expected_size<3>(static_cast<double>(report.base_cells), 1, 0, request));
    OntoSurface<3> onto;
    if (const auto* sphere = std::get_if<SphereShape>(&request.input)) {
        onto = onto_sphere(sphere->radius);
        if (request.is_curved) {
            require_vertices_on_sphere(sphere->radius, mesh);
        }
    } else if (const auto* ball = std::get_if<BallShape>(&request.input)) {
        onto = onto_sphere(ball->radius);
    }
    const double expected_volume = request.is_curved ? 0 : report.base_volume;
    return finish<3>({std::move(mesh), std::move(extras), std::move(report), {}}, expected_volume,
                     request, clock, onto);
}

bool is_flat(const Surface& surface) {
    const auto z = surface.points.row(2);
    return z.maxCoeff() == z.minCoeff();
}

// The triangles of a flat surface, all counterclockwise.
SimplexMesh<2> plane_mesh(const Surface& surface, const std::string& name) {
    SimplexMesh<2> mesh;
    mesh.positions = surface.points.topRows<2>();
    mesh.cells = surface.triangles;
    for (Eigen::Index t = 0; t < mesh.cell_count(); ++t) {
        if (cell_volume<2>(mesh.positions, mesh.cells, t) < 0) {
            std::swap(mesh.cells(1, t), mesh.cells(2, t));
        }
    }
    validate(mesh, name);
    if (const Proof proof = prove(mesh); !proof.holds()) {
        throw Error(name + ": the triangles do not fit together: " + describe_faults(proof, 2));
    }
    return mesh;
}

}  // namespace

Body<4> make_body(const BodyRequest& request) {
    check_request(request, 4);
    StageClock clock(request.on_stage);
    if (const auto* shape = std::get_if<BoxShape>(&request.input)) {
        return make_box<4>(*shape, request, clock);
    }
    if (const auto* path = solid_file_of(request)) {
        return make_stuffed(*path, request, clock);
    }
    refuse_image_options(request);
    BodyReport report;
    ExtrusionRequest extrusion = request.extrusion;
    if (has_tetrahedra(request)) {
        refuse_filling(request);
        const BaseMesh base = read_base(request, report, clock);
        return extrude_and_prove<4>(base.mesh, base.extras, request, extrusion, std::move(report),
                                    clock);
    }
    const SurfaceFile file = clock.time("read", [&] { return surface_of(request); });
    report.left_out = file.left_out;
    const SimplexMesh<3> base = filled_base<4>(file, request, extrusion, report, clock);
    return extrude_and_prove<4>(base, {}, request, extrusion, std::move(report), clock);
}

Body<3> make_solid(const BodyRequest& request) {
    check_request(request, 3);
    StageClock clock(request.on_stage);
    if (const auto* shape = std::get_if<BoxShape>(&request.input)) {
        return make_box<3>(*shape, request, clock);
    }
    if (const auto* path = solid_file_of(request)) {
        throw Error(path->string() + ": is a shape of four dimensions; leave out --dim 3");
    }
    refuse_image_options(request);
    BodyReport report;
    if (has_tetrahedra(request)) {
        refuse_extrusion(request);
        refuse_filling(request);
        BaseMesh base = read_base(request, report, clock);
        return finish_solid(std::move(base.mesh), std::move(base.extras), request,
                            std::move(report), clock);
    }
    const SurfaceFile file = clock.time("read", [&] { return surface_of(request); });
    report.left_out = file.left_out;
    if (is_flat(file.surface)) {
        refuse_filling(request);
        report.merged_points = file.merged_points;
        report.generator = "as read";
        BodyRequest lifted = request;  // to where the triangles are
        lifted.translation = Eigen::Vector3d(0, 0, file.surface.points(2, 0));
        lifted.translation.head(request.translation.size()) += request.translation;
        return extrude_and_prove<3>(plane_mesh(file.surface, name_of_input(request)), {}, lifted,
                                    request.extrusion, std::move(report), clock);
    }
    refuse_extrusion(request);
    if (request.target_cells > 0) {
        throw Error(name_of_input(request)
                    + ": a number of pentachora is for bodies of four dimensions; ask for an edge"
                      " length instead");
    }
    ExtrusionRequest none;
    SimplexMesh<3> mesh = filled_base<3>(file, request, none, report, clock);
    return finish_solid(std::move(mesh), {}, request, std::move(report), clock);
}

}  // namespace pent::mesher
