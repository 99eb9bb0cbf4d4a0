#include "base_mesh.h"

#include "size_limits.h"
#include "sound_base.h"

#include <pent/error.h>
#include <pent/input_path.h>
#include <pent/mesher/orient.h>
#include <pent/mesher/read_surface.h>
#include <pent/mesher/read_tetrahedra.h>
#include <pent/mesher/resample.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pent::mesher {

namespace {

Repaired mend(const Surface& surface, const BodyRequest& request, Repair level) {
    RepairOptions options = request.repair;
    options.repair = level;
    return with_name(request, [&] { return repair(surface, options); });
}

void add_failure(BodyReport& report, const std::string& failure) {
    if (!failure.empty()) {
        report.failures += (report.failures.empty() ? "" : "; ") + failure;
    }
}

Surface oriented_surface(const Repaired& mended, const BodyRequest& request, BodyReport& report) {
    report.repair = mended.used;
    report.repair_distance = mended.distance;
    add_failure(report, mended.failures);
    report.surface_read = mended.before;
    Oriented oriented = with_name(request, [&] { return orient(mended.surface); });
    report.flipped_triangles = oriented.flipped_triangles;
    report.components = oriented.components;
    report.cavities = oriented.cavities;
    return std::move(oriented.surface);
}

// How many equilateral triangles with this edge a surface would have; at least as many as it takes
// to keep a shape.
std::int64_t triangles_for(double surface_area, double edge_length) {
    const double triangle = std::sqrt(3.0) / 4 * edge_length * edge_length;
    return std::llround(std::clamp(surface_area / triangle, 64.0, 1e9));
}

}  // namespace

std::string name_of_input(const BodyRequest& request) {
    const auto* path = std::get_if<std::filesystem::path>(&request.input);
    return path != nullptr ? input_name(*path) : "the shape";
}

bool has_tetrahedra(const BodyRequest& request) {
    const auto* path = std::get_if<std::filesystem::path>(&request.input);
    return std::holds_alternative<BallShape>(request.input)
           || (path != nullptr && is_tetrahedra_file(*path, request.format));
}

SurfaceFile surface_of(const BodyRequest& request) {
    SurfaceFile file;
    if (const auto* shape = std::get_if<SphereShape>(&request.input)) {
        file.surface = sphere(shape->frequency);
        file.surface.points *= shape->radius;
        require_usual_size<3>(file.surface.points, name_of_input(request) + ": the surface");
        return file;
    }
    file = read_surface(std::get<std::filesystem::path>(request.input), request.format,
                        request.repair.limits);
    file.surface.points *= request.scale;
    return file;
}

BaseMesh read_base(const BodyRequest& request, BodyReport& report, StageClock& clock) {
    if (const auto* shape = std::get_if<BallShape>(&request.input)) {
        SimplexMesh<3> mesh = ball(shape->frequency);
        mesh.positions *= shape->radius;
        require_usual_size<3>(mesh.positions, name_of_input(request) + ": the mesh");
        report.generator = "cones of a sphere";
        return {std::move(mesh), {}};
    }
    TetrahedraFile file = clock.time("read", [&] {
        return read_tetrahedra(std::get<std::filesystem::path>(request.input), request.format,
                               request.region_array);
    });
    file.mesh.positions *= request.scale;
    require_usual_size<3>(file.mesh.positions, name_of_input(request) + ": the mesh");
    require_sound_base(file.mesh, name_of_input(request));
    report.cut = std::move(file.cut);
    report.left_out = std::move(file.left_out);
    report.curved_cells = file.curved_cells;
    report.region_array = std::move(file.region_array);
    report.generator = file.turned_cells > 0
                           ? "as read, " + std::to_string(file.turned_cells) + " turned over"
                           : "as read";
    return {std::move(file.mesh), std::move(file.extras)};
}

Tetrahedra fill_at(const Surface& surface,
                   double edge_length,
                   const BodyRequest& request,
                   Surface& filled) {
    TetrahedraOptions options = request.tetrahedra;
    filled = surface;
    if (request.surface_triangles > 0) {
        filled = resample(surface, request.surface_triangles, options.limits);
    } else if (edge_length > 0) {
        filled = resample(surface, triangles_for(area(surface), edge_length), options.limits);
    }
    if (edge_length > 0) {
        options.edge_length = edge_length;
    }
    return tetrahedralize(filled, options);
}

FillEstimate estimate_filling(const Surface& surface, const BodyRequest& request) {
    // Found for surfaces of 10^3 to 10^5 triangles: 2 to 4 tetrahedra a triangle, and seconds a
    // tetrahedron of either generator on one core.
    constexpr double kPerTriangle = 3;
    constexpr double kTetGenSeconds = 20e-6;
    constexpr double kMesh3Seconds = 170e-6;
    const double skin = area(surface);
    double triangles = static_cast<double>(surface.triangle_count());
    FillEstimate estimate;
    if (request.surface_triangles > 0) {
        triangles = static_cast<double>(request.surface_triangles);
    } else if (request.edge_length > 0) {
        triangles = skin / (std::sqrt(3.0) / 4 * request.edge_length * request.edge_length);
        estimate.tetrahedra = enclosed_volume(surface) * 6 * std::sqrt(2.0) * kCrowding
                              / std::pow(request.edge_length, 3);
    }
    estimate.tetrahedra = std::max(estimate.tetrahedra, kPerTriangle * triangles);
    estimate.edge = std::sqrt(skin / triangles * 4 / std::sqrt(3.0));
    estimate.seconds =
        estimate.tetrahedra
        * (request.tetrahedra.generator == Generator::Mesh3 ? kMesh3Seconds : kTetGenSeconds);
    return estimate;
}

SimplexMesh<3> fill_base(const SurfaceFile& file,
                         const BodyRequest& request,
                         const std::function<void(const Surface&)>& before_filling,
                         const Fill& fill,
                         BodyReport& report,
                         StageClock& clock) {
    report.merged_points = file.merged_points;
    const auto mend_to = [&](Repair level) {
        Surface surface = clock.time("mend", [&] {
            return oriented_surface(mend(file.surface, request, level), request, report);
        });
        before_filling(surface);
        return surface;
    };
    Surface filled;
    const auto fill_it = [&](const Surface& surface) {
        return clock.time("fill", [&] { return fill(surface, filled); });
    };
    Tetrahedra tetrahedra;
    const Surface surface = mend_to(request.repair.repair);
    try {
        tetrahedra = fill_it(surface);
    } catch (const Error& error) {
        if (request.repair.repair != Repair::Auto || report.repair == Repair::Wrap) {
            throw Error(name_of_input(request) + ": " + error.what());
        }
        add_failure(report, error.what());
        const Surface wrap = mend_to(Repair::Wrap);
        tetrahedra = with_name(request, [&] { return fill_it(wrap); });
    }
    report.surface = check_surface(filled);
    report.surface_area = area(filled);
    report.generator = tetrahedra.generator;
    add_failure(report, tetrahedra.failures);
    return std::move(tetrahedra.mesh);
}

}  // namespace pent::mesher
