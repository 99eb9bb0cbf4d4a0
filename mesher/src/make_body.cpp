#include "base_mesh.h"
#include "check_request.h"
#include "extrude_fields.h"
#include "fill_target.h"
#include "requested_layers.h"
#include "size_limits.h"
#include "solid_input.h"
#include "stage_clock.h"

#include <pent/error.h>
#include <pent/facets.h>
#include <pent/mesher/links.h>
#include <pent/mesher/make_body.h>
#include <pent/mesher/stuff.h>
#include <pent/mesher/subdivide.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

namespace pent::mesher {

namespace {

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

// In how many parts every edge is cut at the end.
int parts_of_edge(const BodyRequest& request) {
    return request.subdivide * (request.is_quadratic ? 2 : 1);
}

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

// Moves a body of mesh, quantities and report where it is asked for, proves and measures it;
// subdivides it first if that is asked for.
//
// @param onto  Where a curved boundary's middles go; empty where the surface is flat.
template <int Dim>
Body<Dim> finish(Body<Dim> body,
                 double expected_volume,
                 const BodyRequest& request,
                 StageClock& clock,
                 const OntoSurface<Dim>& onto = {}) {
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
    validate(mesh, "the mesh that was made");
    report.proof = clock.time("prove", [&] { return prove<Dim>(mesh, expected_volume); });
    if (!report.proof.holds()) {
        // GCOVR_EXCL_START: the construction is proven; this is for mistakes of ours
        throw Error("the mesh that was made is not sound: " + describe_faults(report.proof, Dim));
        // GCOVR_EXCL_STOP
    }
    report.quality = clock.time("quality", [&] { return measure_quality<Dim>(mesh); });
    report.stages = clock.stages();
    return body;
}

void announce(const BodyRequest& request, const ExpectedSize& size) {
    if (request.on_size) {
        request.on_size(size);
    }
}

// Cells and seconds of a body of which the base and the number of slabs are known.
template <int Dim>
ExpectedSize expected_size(double base_cells,
                           double cells_over,
                           int slabs,
                           const BodyRequest& request) {
    constexpr double kSeconds = 0.4e-6;  // to extrude, prove and measure a cell on one core
    ExpectedSize size;
    size.base_cells = base_cells;
    size.layers = slabs;
    size.cells = base_cells * cells_over * std::pow(parts_of_edge(request), Dim);
    size.seconds = kSeconds * size.cells;
    return size;
}

template <int Dim>
void note_heights(const std::vector<Layer<Dim>>& layers, BodyReport& report) {
    report.lowest_layer = std::numeric_limits<double>::infinity();
    for (std::size_t l = 1; l < layers.size(); ++l) {
        const double height = (layers[l].offset - layers[l - 1].offset).norm();
        report.lowest_layer = std::min(report.lowest_layer, height);
        report.highest_layer = std::max(report.highest_layer, height);
    }
}

// All of a base's boundary meets at the point where a body ends.
template <int Dim>
void require_manifold(const SimplexMesh<Dim>& mesh, const std::string& name) {
    if (const LinkReport links = check_links(mesh); links.faulty > 0) {
        throw Error(name + ": a body that ends in a point needs a base in one piece, without holes"
                      " and cavities; expected a profile that ends with a scale above 0, or a"
                      " straight extrusion");
    }
}

// What the file of a body that is kept as base and layers does not say of it.
template <int Dim>
void leave_out_fields(const SimplexMesh<Dim>& base,
                      const MeshExtras<Dim>& fields,
                      BodyReport& report) {
    std::vector<std::string> names;
    for (const std::vector<VertexField>& some : {fields.vertex_fields, fields.cell_fields}) {
        for (const VertexField& field : some) {
            names.push_back(field.name);
        }
    }
    if (base.fibers.cols() > 0) {
        names.emplace_back("fibers");
    }
    for (const std::string& name : names) {
        report.left_out += (report.left_out.empty() ? "" : ", ") + name
                           + " (base and layers have no place for it)";
    }
}

template <int Dim>
Body<Dim> extrude_and_prove(const SimplexMesh<Dim - 1>& base,
                            const MeshExtras<Dim - 1>& fields,
                            const BodyRequest& request,
                            const ExtrusionRequest& extrusion,
                            BodyReport report,
                            StageClock& clock) {
    report.base_vertices = base.vertex_count();
    report.base_cells = base.cell_count();
    report.base_volume = total_volume(base);
    report.base_edge = mean_edge<Dim - 1>(base);
    Layers<Dim> layers = requested_layers<Dim>(
        extrusion, {largest_side<Dim - 1>(base.positions), report.base_volume, report.base_edge});
    report.direction = layers.layers.back().offset - layers.layers.front().offset;
    report.layers = static_cast<int>(layers.layers.size()) - 1;
    note_heights<Dim>(layers.layers, report);
    if (request.target_cells == 0) {
        announce(request, expected_size<Dim>(static_cast<double>(report.base_cells),
                                             layers.cells_over(), report.layers, request));
    }
    OrderedCells<Dim - 1> ordered = clock.time("order", [&] {
        return ordered_cells<Dim - 1>(extrusion, base, report.direction / report.layers);
    });
    for (Layer<Dim>& layer : layers.layers) {
        layer.offset.head(request.translation.size()) += request.translation;
    }
    BodyRequest moved = request;  // so that base and layers are where the body is
    moved.translation.resize(0);
    const ExtrudeOptions options{.alternate = extrusion.alternate};
    Body<Dim> body;
    body.mesh =
        clock.time("extrude", [&] { return extrude<Dim>(base, ordered, layers.layers, options); });
    if (layers.layers.front().is_point() || layers.layers.back().is_point()) {
        require_manifold(body.mesh, name_of_input(request));
    }
    if (extrusion.is_kept) {
        leave_out_fields(base, fields, report);
    } else {
        body.extras = extrude_fields<Dim>(base, fields, layers.layers, body.mesh);
    }
    body.report = std::move(report);
    body = finish<Dim>(std::move(body), layers.volume, moved, clock);
    if (extrusion.is_kept) {
        body.extrusion = {base, std::move(ordered), std::move(layers.layers), options};
    }
    return body;
}

// Fixes the number of layers first, then seeks the edge length that gives the tetrahedra left.
Tetrahedra fill_to_cells(const Surface& surface,
                         const BodyRequest& request,
                         ExtrusionRequest& extrusion,
                         Surface& filled,
                         BodyReport& report) {
    const double regular = enclosed_volume(surface) * 6 * std::sqrt(2.0) * kCrowding;
    const double side = largest_side<3>(surface.points);
    const double cells =
        static_cast<double>(request.target_cells) / std::pow(parts_of_edge(request), 4);
    if (has_automatic_layers(extrusion)) {
        const double height = extrusion_length(extrusion, side);
        const double edge_length = std::pow(4 * regular * height / (0.7 * cells), 0.25);
        extrusion.layers = suitable_slabs(extrusion, side, edge_length);
    }
    const double tets = cells / requested_layers<4>(extrusion, {side, 0, 0}).cells_over();
    TargetFilling found =
        fill_to_target([&](double length) { return fill_at(surface, length, request, filled); },
                       tets, std::cbrt(regular / tets));
    report.fillings = found.fillings;
    return std::move(found.tetrahedra);
}

// Says how many cells a surface will give, before it is filled.
template <int Dim>
void announce_filling(const Surface& surface, const BodyRequest& request) {
    if (request.target_cells > 0) {
        return;
    }
    const FillEstimate filling = estimate_filling(surface, request);
    int slabs = 0;
    double cells_over = 1;
    if constexpr (Dim == 4) {
        const Layers<4> layers = requested_layers<4>(
            request.extrusion, {largest_side<3>(surface.points), 0, filling.edge});
        slabs = static_cast<int>(layers.layers.size()) - 1;
        cells_over = layers.cells_over();
    }
    ExpectedSize size = expected_size<Dim>(filling.tetrahedra, cells_over, slabs, request);
    size.seconds += filling.seconds;
    announce(request, size);
}

template <int Dim>
SimplexMesh<3> filled_base(const SurfaceFile& file,
                           const BodyRequest& request,
                           ExtrusionRequest& extrusion,
                           BodyReport& report,
                           StageClock& clock) {
    const Fill fill = [&](const Surface& surface, Surface& filled) {
        return request.target_cells > 0 ? fill_to_cells(surface, request, extrusion, filled, report)
                                        : fill_at(surface, request.edge_length, request, filled);
    };
    return fill_base(
        file, request, [&](const Surface& surface) { announce_filling<Dim>(surface, request); },
        fill, report, clock);
}

template <int Dim>
Body<Dim> make_box(const BoxShape& shape, const BodyRequest& request, StageClock& clock) {
    refuse_extrusion(request);
    refuse_filling(request);
    refuse_image_options(request);
    if (shape.count.size() != Dim || shape.size.size() != Dim) {
        throw Error("a box of " + std::to_string(shape.count.size()) + " axes; expected "
                    + std::to_string(Dim));
    }
    std::array<int, Dim> count{};
    std::array<double, Dim> size{};
    std::copy(shape.count.begin(), shape.count.end(), count.begin());
    std::copy(shape.size.begin(), shape.size.end(), size.begin());
    const double cubes =
        std::accumulate(count.begin(), count.end(), 1.0, std::multiplies<double>());
    const bool is_by_paths = shape.cut == CubeCut::Paths;
    const double per_cube = Dim == 4 ? (is_by_paths ? 24 : 16) : (is_by_paths ? 6 : 5);
    announce(request, expected_size<Dim>(cubes * per_cube, 1, 0, request));
    SimplexMesh<Dim> mesh = clock.time("cut", [&] { return box<Dim>(count, size, shape.cut); });
    const Eigen::Map<const Eigen::Matrix<double, Dim, 1>> extent(size.data());
    mesh.positions.colwise() -= extent / 2;
    require_usual_size<Dim>(mesh.positions, name_of_input(request) + ": the body");
    BodyReport report;
    report.generator = Dim == 4 ? "tesseracts" : "cubes";
    return finish<Dim>({std::move(mesh), {}, std::move(report), {}}, extent.prod(), request, clock);
}

// Of a sphere that was made anew the vertices are on the flat triangles it had before, where
// nothing can be curved.
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
    report.base_vertices = mesh.vertex_count();
    report.base_cells = mesh.cell_count();
    report.base_volume = total_volume(mesh);
    report.base_edge = mean_edge<3>(mesh);
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

// The size field where the body is before it is moved.
SizeField before_translation(const BodyRequest& request) {
    SizeField sizes = request.sizes;
    if (request.translation.size() > 0) {
        Eigen::Vector4d way = Eigen::Vector4d::Zero();
        way.head(request.translation.size()) = request.translation;
        if (sizes.plane) {
            sizes.plane->offset -= sizes.plane->normal.dot(way);
        }
        if (sizes.point) {
            *sizes.point -= way;
        }
    }
    return sizes;
}

Body<4> make_stuffed(const std::filesystem::path& path,
                     const BodyRequest& request,
                     StageClock& clock) {
    refuse_extrusion(request);
    check_solid_request(path, request);
    const SolidInput input = clock.time("read", [&] { return read_solid_input(path, request); });
    StuffedSolid stuffed;
    try {
        const SizeField sizes = before_translation(request);
        ExpectedSize size = expected_size<4>(
            estimate_cells(input.solid, request.edge_length, sizes), 1, 0, request);
        size.seconds += input.seconds_per_cell * size.cells;
        announce(request, size);
        stuffed =
            clock.time("stuff", [&] { return stuff(input.solid, request.edge_length, sizes); });
    } catch (const Error& error) {
        throw Error(path.string() + ": " + error.what());
    }
    if (input.labels) {
        stuffed.mesh.regions = label_regions(stuffed.mesh, *input.labels, request.scale);
    }
    BodyReport report;
    report.boundary = input.boundary;
    report.generator = "lattice stuffing";
    report.beveled = stuffed.beveled;
    report.thin_parts = stuffed.thin_parts;
    report.thin_parts.place.head(request.translation.size()) += request.translation;
    return finish<4>({std::move(stuffed.mesh), {}, std::move(report), {}}, 0, request, clock,
                     onto_boundary(input.solid));
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
