#include "fill_target.h"

#include <pent/error.h>
#include <pent/mesher/make_body.h>
#include <pent/mesher/orient.h>
#include <pent/mesher/profile.h>
#include <pent/mesher/read_tetrahedra.h>
#include <pent/mesher/resample.h>
#include <pent/mesher/subdivide.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
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

std::string name_of_input(const BodyRequest& request) {
    const auto* path = std::get_if<std::filesystem::path>(&request.input);
    return path != nullptr ? path->string() : "the shape";
}

SurfaceFile surface_of(const BodyRequest& request) {
    if (const auto* shape = std::get_if<SphereShape>(&request.input)) {
        SurfaceFile file;
        file.surface = sphere(shape->frequency);
        file.surface.points *= shape->radius;
        return file;
    }
    return read_surface(std::get<std::filesystem::path>(request.input));
}

bool has_tetrahedra(const BodyRequest& request) {
    const auto* path = std::get_if<std::filesystem::path>(&request.input);
    return std::holds_alternative<BallShape>(request.input)
           || (path != nullptr && is_tetrahedra_file(*path));
}

Repaired mend(const Surface& surface, const BodyRequest& request, Repair level) {
    RepairOptions options = request.repair;
    options.repair = level;
    try {
        return repair(surface, options);
    } catch (const Error& error) {
        throw Error(name_of_input(request) + ": " + error.what());
    }
}

void add_failure(BodyReport& report, const std::string& failure) {
    if (!failure.empty()) {
        report.failures += (report.failures.empty() ? "" : "; ") + failure;
    }
}

Surface oriented_surface(const Repaired& mended, BodyReport& report) {
    report.repair = mended.used;
    report.repair_distance = mended.distance;
    add_failure(report, mended.failures);
    report.surface_read = mended.before;
    Oriented oriented = orient(mended.surface);
    report.flipped_triangles = oriented.flipped_triangles;
    report.components = oriented.components;
    report.cavities = oriented.cavities;
    return std::move(oriented.surface);
}

template <int Dim>
double largest_side(const Positions<Dim>& positions) {
    return (positions.rowwise().maxCoeff() - positions.rowwise().minCoeff()).maxCoeff();
}

template <int Dim>
Eigen::Matrix<double, Dim, 1> direction_of(const ExtrusionRequest& request, double largest_side) {
    Eigen::Matrix<double, Dim, 1> direction = Eigen::Matrix<double, Dim, 1>::Zero();
    if (request.direction) {
        if (request.direction->size() != Dim) {
            throw Error("an extrusion of " + std::to_string(request.direction->size())
                        + " components; expected " + std::to_string(Dim));
        }
        direction = *request.direction;
    } else {
        direction[Dim - 1] = request.thickness.value_or(0.2 * largest_side);
    }
    if (!direction.allFinite() || direction[Dim - 1] == 0) {
        throw Error("an extrusion by " + std::to_string(direction[Dim - 1]) + " along "
                    + "xyzw"[Dim - 1] + "; expected a finite number other than 0");
    }
    return direction;
}

template <int Dim>
OrderedCells<Dim> ordered_cells(const ExtrusionRequest& request,
                                const SimplexMesh<Dim>& base,
                                const Eigen::Matrix<double, Dim + 1, 1>& slab) {
    if (!request.edge_directions.empty()) {
        return order_cells<Dim>(base,
                                read_directed_edges(request.edge_directions, base.vertex_count()));
    }
    std::vector<std::uint32_t> ranks = rank_vertices<Dim>(base, request.order);
    if (request.order == VertexOrder::Quality) {
        ranks = improve_ranks<Dim>(base, std::move(ranks), slab);
    }
    return order_cells<Dim>(base, direct_edges<Dim>(base, ranks));
}

// The layers that are asked for, and what is known of the volume they enclose.
template <int Dim>
struct Layers {
    std::vector<Layer<Dim>> layers;
    double volume = 0;  // m^Dim, or 0
};

std::optional<Layers<4>> curved_layers(const ExtrusionRequest& request,
                                       const SimplexMesh<3>& base,
                                       double edge) {
    if (!request.profile.empty()) {
        return Layers<4>{read_profile(request.profile)};
    }
    if (!request.round) {
        return std::nullopt;
    }
    const double height = request.thickness.value_or(largest_side<3>(base.positions));
    if (!std::isfinite(height) || height == 0) {
        throw Error("a round body of height " + std::to_string(height)
                    + "; expected a finite number other than 0");
    }
    // Half the meridian is as long as the layers together are high.
    const double meridian = std::numbers::pi / 2 * std::abs(height);
    const int slabs = request.layers > 0 ? request.layers : automatic_slabs(meridian, edge);
    return Layers<4>{round_layers(height / 2, std::max(slabs, 2))};
}

std::optional<Layers<3>> curved_layers(const ExtrusionRequest& request,
                                       const SimplexMesh<2>& /*base*/,
                                       double /*edge*/) {
    if (!request.profile.empty() || request.round) {
        throw Error("profiles and round bodies are for dimension 4");
    }
    return std::nullopt;
}

template <int Dim>
Layers<Dim> layers_for(const ExtrusionRequest& request,
                       const SimplexMesh<Dim - 1>& base,
                       const BodyReport& report) {
    if (const auto curved = curved_layers(request, base, report.base_edge)) {
        return *curved;
    }
    const Eigen::Matrix<double, Dim, 1> direction =
        direction_of<Dim>(request, largest_side<Dim - 1>(base.positions));
    const int slabs =
        request.layers > 0 ? request.layers : automatic_slabs(direction.norm(), report.base_edge);
    return {straight_layers<Dim>(direction, slabs, request.anchor),
            report.base_volume * std::abs(direction[Dim - 1])};
}

// Proves and measures the mesh; subdivides it first if that is asked for.
template <int Dim>
Body<Dim> finish(
    SimplexMesh<Dim> mesh, double expected_volume, int parts, BodyReport report, Clock& clock) {
    if (parts > 1) {
        mesh = clock.time("subdivide", [&] { return subdivide<Dim>(mesh, parts); });
    }
    validate(mesh, "the mesh that was made");
    report.proof = clock.time("prove", [&] { return prove<Dim>(mesh, expected_volume); });
    if (!report.proof.holds()) {
        // GCOVR_EXCL_START: the construction is proven; this is for mistakes of ours
        throw Error("the mesh that was made is not sound: " + describe_faults(report.proof, Dim));
        // GCOVR_EXCL_STOP
    }
    report.quality = clock.time("quality", [&] { return measure_quality<Dim>(mesh); });
    return {std::move(mesh), std::move(report)};
}

template <int Dim>
Body<Dim> extrude_and_prove(const SimplexMesh<Dim - 1>& base,
                            const BodyRequest& request,
                            const ExtrusionRequest& extrusion,
                            BodyReport report,
                            Clock& clock) {
    report.base_vertices = base.vertex_count();
    report.base_cells = base.cell_count();
    report.base_volume = total_volume(base);
    report.base_edge = mean_edge<Dim - 1>(base);
    const Layers<Dim> layers = layers_for<Dim>(extrusion, base, report);
    report.direction = layers.layers.back().offset - layers.layers.front().offset;
    report.layers = static_cast<int>(layers.layers.size()) - 1;
    const OrderedCells<Dim - 1> ordered = clock.time("order", [&] {
        return ordered_cells<Dim - 1>(extrusion, base, report.direction / report.layers);
    });
    SimplexMesh<Dim> mesh = clock.time("extrude", [&] {
        return extrude<Dim>(base, ordered, layers.layers, {.alternate = extrusion.alternate});
    });
    return finish<Dim>(std::move(mesh), layers.volume, request.subdivide, report, clock);
}

// Triangles of a surface if all were regular with this edge; few are not enough to keep a shape.
std::int64_t triangles_for(double surface_area, double edge_length) {
    const double triangle = std::sqrt(3.0) / 4 * edge_length * edge_length;
    return std::llround(std::clamp(surface_area / triangle, 64.0, 1e9));
}

// Resamples the surface if an edge length or a number of triangles is asked for, and fills it.
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

// Fixes the number of layers first, then seeks the edge length that gives the tetrahedra left.
Tetrahedra fill_to_cells(const Surface& surface,
                         const BodyRequest& request,
                         ExtrusionRequest& extrusion,
                         Surface& filled,
                         BodyReport& report) {
    // Tetrahedra over what regular ones of the same edge would number, as TetGen has it.
    constexpr double kCrowding = 1.3;
    const double regular = enclosed_volume(surface) * 6 * std::sqrt(2.0) * kCrowding;
    const double height = direction_of<4>(extrusion, largest_side<3>(surface.points)).norm();
    const auto cells = static_cast<double>(request.target_cells);
    double edge_length = 0;
    if (extrusion.layers == 0) {
        edge_length = std::pow(4 * regular * height / (0.7 * cells), 0.25);
        extrusion.layers = automatic_slabs(height, edge_length);
    }
    const double tets = cells / (4 * extrusion.layers);
    edge_length = std::cbrt(regular / tets);
    TargetFilling found =
        fill_to_target([&](double length) { return fill_at(surface, length, request, filled); },
                       tets, edge_length);
    report.fillings = found.fillings;
    return std::move(found.tetrahedra);
}

SimplexMesh<3> fill_base(const BodyRequest& request,
                         ExtrusionRequest& extrusion,
                         BodyReport& report,
                         Clock& clock) {
    const SurfaceFile file = clock.time("read", [&] { return surface_of(request); });
    report.merged_points = file.merged_points;
    Surface filled;
    const auto fill = [&](const Surface& surface) {
        return clock.time("fill", [&] {
            return request.target_cells > 0
                       ? fill_to_cells(surface, request, extrusion, filled, report)
                       : fill_at(surface, request.edge_length, request, filled);
        });
    };
    Tetrahedra tetrahedra;
    const auto mend_and_fill = [&](Repair level) {
        const Surface surface = clock.time(
            "mend", [&] { return oriented_surface(mend(file.surface, request, level), report); });
        tetrahedra = fill(surface);
    };
    try {
        mend_and_fill(request.repair.repair);
    } catch (const Error& error) {
        if (request.repair.repair != Repair::Auto || report.repair == Repair::Wrap
            || report.surface_read.triangles == 0) {
            throw;
        }
        add_failure(report, error.what());
        mend_and_fill(Repair::Wrap);
    }
    report.surface = check_surface(filled);
    report.surface_area = area(filled);
    report.generator = tetrahedra.generator;
    add_failure(report, tetrahedra.failures);
    return std::move(tetrahedra.mesh);
}

SimplexMesh<3> read_base(const BodyRequest& request, BodyReport& report, Clock& clock) {
    if (const auto* shape = std::get_if<BallShape>(&request.input)) {
        SimplexMesh<3> mesh = ball(shape->frequency);
        mesh.positions *= shape->radius;
        report.generator = "cones of a sphere";
        return mesh;
    }
    TetrahedraFile file = clock.time(
        "read", [&] { return read_tetrahedra(std::get<std::filesystem::path>(request.input)); });
    const Proof proof = prove(file.mesh);
    if (!proof.holds()) {
        throw Error(name_of_input(request)
                    + ": the tetrahedra do not fit together: " + describe_faults(proof, 3));
    }
    report.cut = std::move(file.cut);
    report.left_out = std::move(file.left_out);
    report.curved_cells = file.curved_cells;
    report.generator = file.turned_cells > 0
                           ? "as read, " + std::to_string(file.turned_cells) + " turned over"
                           : "as read";
    return std::move(file.mesh);
}

Body<4> make_box(const BoxShape& shape,
                 const BodyRequest& request,
                 BodyReport report,
                 Clock& clock) {
    SimplexMesh<4> mesh =
        clock.time("cut", [&] { return box<4>(shape.count, shape.size, shape.cut); });
    const Eigen::Map<const Eigen::Vector4d> size(shape.size.data());
    mesh.positions.colwise() -= size / 2;
    report.generator = "tesseracts";
    return finish<4>(std::move(mesh), size.prod(), request.subdivide, std::move(report), clock);
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
    if (const auto* shape = std::get_if<BoxShape>(&request.input)) {
        Body<4> body = make_box(*shape, request, report, clock);
        body.report.stages = std::move(stages);
        return body;
    }
    ExtrusionRequest extrusion = request.extrusion;
    const SimplexMesh<3> base = has_tetrahedra(request)
                                    ? read_base(request, report, clock)
                                    : fill_base(request, extrusion, report, clock);
    Body<4> body = extrude_and_prove<4>(base, request, extrusion, report, clock);
    body.report.stages = std::move(stages);
    return body;
}

Body<3> make_body_from_plane(const BodyRequest& request) {
    BodyReport report;
    std::vector<Stage> stages;
    Clock clock(stages);
    const SurfaceFile file = clock.time("read", [&] { return surface_of(request); });
    const SimplexMesh<2> base = plane_mesh(file.surface, name_of_input(request));
    report.merged_points = file.merged_points;
    report.generator = "as read";
    Body<3> body = extrude_and_prove<3>(base, request, request.extrusion, report, clock);
    body.report.stages = std::move(stages);
    return body;
}

}  // namespace pent::mesher
