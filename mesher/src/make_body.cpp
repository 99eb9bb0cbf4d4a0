#include <pent/error.h>
#include <pent/mesher/make_body.h>
#include <pent/mesher/orient.h>
#include <pent/mesher/resample.h>

#include <chrono>
#include <cmath>
#include <utility>

namespace pent::mesher {

namespace {

// Runs one stage and notes how long it took.
class Clock {
public:
    explicit Clock(std::vector<Stage>& stages) : stages_(stages) {}

    template <typename Work>
    auto time(const char* name, Work work) {
        const auto start = std::chrono::steady_clock::now();
        auto result = work();
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        stages_.push_back({name, seconds.count()});
        return result;
    }

private:
    std::vector<Stage>& stages_;
};

Surface clean_surface(const BodyRequest& request, BodyReport& report, Clock& clock) {
    const std::string name = request.input.string();
    const SurfaceFile file = clock.time("read", [&] { return read_surface(request.input); });
    report.merged_points = file.merged_points;
    report.surface = clock.time("check", [&] { return check_surface(file.surface); });
    if (!report.surface.is_clean()) {
        throw Error(name + ": not the boundary of a body: " + describe(report.surface));
    }
    Oriented oriented = clock.time("orient", [&] { return orient(file.surface); });
    report.flipped_triangles = oriented.flipped_triangles;
    report.components = oriented.components;
    report.cavities = oriented.cavities;
    if (request.surface_triangles == 0) {
        return std::move(oriented.surface);
    }
    Surface resampled = clock.time(
        "resample", [&] { return resample(oriented.surface, request.surface_triangles); });
    report.surface = check_surface(resampled);
    return resampled;
}

template <int Dim>
Eigen::Matrix<double, Dim, 1> direction_of(const ExtrusionRequest& request,
                                           const SimplexMesh<Dim - 1>& base) {
    Eigen::Matrix<double, Dim, 1> direction = Eigen::Matrix<double, Dim, 1>::Zero();
    if (request.direction) {
        if (request.direction->size() != Dim) {
            throw Error("an extrusion of " + std::to_string(request.direction->size())
                        + " components; expected " + std::to_string(Dim));
        }
        direction = *request.direction;
    } else {
        const double largest =
            (base.positions.rowwise().maxCoeff() - base.positions.rowwise().minCoeff()).maxCoeff();
        direction[Dim - 1] = request.thickness.value_or(0.2 * largest);
    }
    if (!direction.allFinite() || direction[Dim - 1] == 0) {
        throw Error("an extrusion by " + std::to_string(direction[Dim - 1]) + " along "
                    + "xyzw"[Dim - 1] + "; expected a finite number other than 0");
    }
    return direction;
}

template <int Dim>
OrderedCells<Dim> ordered_cells(const ExtrusionRequest& request, const SimplexMesh<Dim>& base) {
    const DirectedEdges edges =
        request.edge_directions.empty()
            ? direct_edges<Dim>(base, rank_vertices<Dim>(base, request.order))
            : read_directed_edges(request.edge_directions, base.vertex_count());
    return order_cells<Dim>(base, edges);
}

template <int Dim>
Body<Dim> extrude_and_prove(const SimplexMesh<Dim - 1>& base,
                            const ExtrusionRequest& request,
                            BodyReport report,
                            Clock& clock) {
    report.base_vertices = base.vertex_count();
    report.base_cells = base.cell_count();
    report.base_volume = total_volume(base);
    report.base_edge = mean_edge<Dim - 1>(base);
    const Eigen::Matrix<double, Dim, 1> direction = direction_of<Dim>(request, base);
    report.direction = direction;
    report.layers =
        request.layers > 0 ? request.layers : automatic_slabs(direction.norm(), report.base_edge);
    const OrderedCells<Dim - 1> ordered =
        clock.time("order", [&] { return ordered_cells<Dim - 1>(request, base); });
    Body<Dim> body;
    body.mesh = clock.time("extrude", [&] {
        return extrude<Dim>(base, ordered,
                            straight_layers<Dim>(direction, report.layers, request.anchor),
                            {.alternate = request.alternate});
    });
    validate(body.mesh, "the extruded mesh");
    const double expected = report.base_volume * std::abs(direction[Dim - 1]);
    report.proof = clock.time("prove", [&] { return prove<Dim>(body.mesh, expected); });
    if (!report.proof.holds()) {
        throw Error("the extruded mesh is not sound: " + describe_faults(report.proof, Dim));
    }
    report.quality = clock.time("quality", [&] { return measure_quality<Dim>(body.mesh); });
    body.report = std::move(report);
    return body;
}

// The triangles of a flat surface, all counterclockwise.
SimplexMesh<2> plane_mesh(const Surface& surface, const std::string& name) {
    const auto z = surface.points.row(2);
    if (z.maxCoeff() != z.minCoeff()) {
        throw Error(name + ": z reaches from " + std::to_string(z.minCoeff()) + " to "
                    + std::to_string(z.maxCoeff())
                    + "; expected a flat mesh with one z to extrude along z");
    }
    SimplexMesh<2> mesh;
    mesh.positions = surface.points.topRows<2>();
    mesh.cells = surface.triangles;
    for (Eigen::Index t = 0; t < mesh.cell_count(); ++t) {
        if (cell_volume<2>(mesh.positions, mesh.cells, t) < 0) {
            std::swap(mesh.cells(1, t), mesh.cells(2, t));
        }
    }
    validate(mesh, name);
    return mesh;
}

}  // namespace

Body<4> make_body(const BodyRequest& request) {
    BodyReport report;
    std::vector<Stage> stages;
    Clock clock(stages);
    const Surface surface = clean_surface(request, report, clock);
    report.surface_area = area(surface);
    const Tetrahedra tetrahedra =
        clock.time("fill", [&] { return tetrahedralize(surface, request.tetrahedra); });
    report.generator = tetrahedra.generator;
    Body<4> body = extrude_and_prove<4>(tetrahedra.mesh, request.extrusion, report, clock);
    body.report.stages = std::move(stages);
    return body;
}

Body<3> make_body_from_plane(const BodyRequest& request) {
    BodyReport report;
    std::vector<Stage> stages;
    Clock clock(stages);
    const SurfaceFile file = clock.time("read", [&] { return read_surface(request.input); });
    const SimplexMesh<2> base = plane_mesh(file.surface, request.input.string());
    report.merged_points = file.merged_points;
    report.generator = "as read";
    Body<3> body = extrude_and_prove<3>(base, request.extrusion, report, clock);
    body.report.stages = std::move(stages);
    return body;
}

}  // namespace pent::mesher
