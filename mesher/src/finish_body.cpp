#include "base_mesh.h"
#include "body_steps.h"

#include <pent/error.h>
#include <pent/mesher/subdivide.h>

#include <string>
#include <utility>

namespace pent::mesher {

namespace {

// The mesh with every edge cut in two, its boundary curved if that is asked for.
template <int Dim>
SimplexMesh<Dim> quadratic_mesh(const SimplexMesh<Dim>& mesh,
                                const BodyRequest& request,
                                const OntoSurface<Dim>& onto,
                                CurveReport& report) {
    SimplexMesh<Dim> quadratic = make_quadratic<Dim>(mesh);
    if (request.is_curved) {
        report = curve_boundary<Dim>(mesh, onto, quadratic);
    }
    return quadratic;
}

}  // namespace

template <int Dim>
Body<Dim> finish(Body<Dim> body,
                 double expected_volume,
                 const BodyRequest& request,
                 StageClock& clock,
                 const OntoSurface<Dim>& onto) {
    if (request.is_curved && !onto) {
        throw Error(name_of_input(request)
                    + ": its surface is flat between its vertices; leave out the curved boundary,"
                      " which shape files, images, spheres and balls have");
    }
    SimplexMesh<Dim>& mesh = body.mesh;
    BodyReport& report = body.report;
    if (request.subdivide > 1) {
        mesh = clock.time("subdivide", [&] {
            body.extras = subdivide_fields<Dim>(mesh, body.extras, request.subdivide);
            return subdivide<Dim>(mesh, request.subdivide);
        });
    }
    if (request.is_quadratic) {
        mesh = clock.time("quadratic", [&] {
            body.extras = subdivide_fields<Dim>(mesh, body.extras, 2);
            return quadratic_mesh<Dim>(mesh, request, onto, report.curve);
        });
    }
    for (Eigen::Index axis = 0; axis < request.translation.size(); ++axis) {
        mesh.positions.row(axis).array() += request.translation[axis];
    }
    const std::string name = name_of_input(request) + ": the mesh that was made";
    validate(mesh, name);
    report.proof = clock.time("prove", [&] { return prove<Dim>(mesh, expected_volume); });
    if (!report.proof.holds()) {
        // GCOVR_EXCL_START: the construction is proven; this is for mistakes of ours
        throw Error(name + " is not sound: " + describe_faults(report.proof, Dim));
        // GCOVR_EXCL_STOP
    }
    report.quality = clock.time("quality", [&] { return measure_quality<Dim>(mesh); });
    report.stages = clock.stages();
    return body;
}

template Body<3> finish<3>(Body<3>, double, const BodyRequest&, StageClock&, const OntoSurface<3>&);
template Body<4> finish<4>(Body<4>, double, const BodyRequest&, StageClock&, const OntoSurface<4>&);

}  // namespace pent::mesher
