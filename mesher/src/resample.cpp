#include "cgal_mesh.h"
#include "isolated.h"
#include "refine.h"

#include <pent/error.h>
#include <pent/mesher/resample.h>
#include <pent/mesher/surface_check.h>

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Edge_length_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Midpoint_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <string>
#include <utility>

namespace pent::mesher {

namespace {

namespace sms = CGAL::Surface_mesh_simplification;

template <typename Cost, typename Placement>
Surface collapse(const Surface& surface,
                 std::int64_t triangles,
                 const Cost& cost,
                 const Placement& placement,
                 bool keep_normals) {
    CgalMesh mesh = to_cgal(surface);
    // Edges are 3/2 of the triangles, and the predicate stops below its count.
    const sms::Count_stop_predicate<CgalMesh> stop(static_cast<std::size_t>(3 * triangles / 2 + 1));
    const auto parameters = CGAL::parameters::get_cost(cost).get_placement(placement);
    if (keep_normals) {
        sms::edge_collapse(mesh, stop, parameters.filter(sms::Bounded_normal_change_filter<>()));
    } else {
        sms::edge_collapse(mesh, stop, parameters);
    }
    return from_cgal(mesh);
}

Surface coarsen(const Surface& surface, std::int64_t triangles, const StepLimits& limits) {
    const sms::LindstromTurk_cost<CgalMesh> shape_cost;
    const sms::LindstromTurk_placement<CgalMesh> shape_placement;
    const sms::Edge_length_cost<CgalMesh> length_cost;
    const sms::Midpoint_placement<CgalMesh> middle_placement;
    std::string failure;
    for (int attempt = 0; attempt < 3; ++attempt) {
        try {
            Pieces<3> pieces = run_isolated<3>("coarsening", limits, [&]() -> Pieces<3> {
                Surface coarse =
                    attempt == 2
                        ? collapse(surface, triangles, length_cost, middle_placement, true)
                        : collapse(surface, triangles, shape_cost, shape_placement, attempt == 1);
                return {std::move(coarse.points), std::move(coarse.triangles)};
            });
            Surface coarse{std::move(pieces.points), std::move(pieces.cells)};
            const SurfaceReport report = check_surface(coarse);
            if (report.is_clean() && report.triangles <= triangles) {
                return coarse;
            }
            failure = describe(report);
        } catch (const Error& error) {
            failure = error.what();
        }
    }
    throw Error("the surface cannot be brought from " + std::to_string(surface.triangle_count())
                + " to " + std::to_string(triangles) + " triangles without faults (" + failure
                + "); ask for more triangles");
}

}  // namespace

Surface resample(const Surface& surface, std::int64_t triangles, const StepLimits& limits) {
    if (triangles < 4) {
        throw Error("a surface of " + std::to_string(triangles)
                    + " triangles is asked for; expected 4 or more");
    }
    const std::int64_t even = triangles - triangles % 2;
    if (even == surface.triangle_count()) {
        return surface;
    }
    if (even < surface.triangle_count()) {
        return coarsen(surface, even, limits);
    }
    Surface fine = refine(surface, even);
    const SurfaceReport report = check_surface(fine);
    if (!report.is_clean()) {
        throw Error("the surface cannot be refined to " + std::to_string(even)
                    + " triangles in double precision (" + describe(report) + ")");
    }
    return fine;
}

}  // namespace pent::mesher
