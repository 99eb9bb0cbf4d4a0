#include "base_mesh.h"
#include "body_steps.h"
#include "extrude_fields.h"
#include "requested_layers.h"
#include "size_limits.h"

#include <pent/error.h>
#include <pent/mesher/links.h>
#include <pent/mesher/quantity_names.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace pent::mesher {

namespace {

template <int Dim>
OrderedCells<Dim> ordered_cells(const ExtrusionRequest& request,
                                const SimplexMesh<Dim>& base,
                                const Eigen::Matrix<double, Dim + 1, 1>& slab) {
    if (!request.edge_directions.empty()) {
        const DirectedEdges edges =
            read_directed_edges(request.edge_directions, base.vertex_count());
        try {
            return order_cells<Dim>(base, edges);
        } catch (const Error& error) {
            throw Error(request.edge_directions.string() + ": " + error.what());
        }
    }
    std::vector<std::uint32_t> ranks = rank_vertices<Dim>(base, request.order);
    if (request.order == VertexOrder::Quality) {
        ranks = improve_ranks<Dim>(base, std::move(ranks), slab);
    }
    return order_cells<Dim>(base, direct_edges<Dim>(base, ranks));
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

// Where a body ends in a point, the link of that point in the boundary is the boundary of the base,
// which has to be a single sphere.
template <int Dim>
void require_manifold(const SimplexMesh<Dim>& mesh, const std::string& name) {
    if (const LinkReport links = check_links(mesh); links.faulty > 0) {
        throw Error(name + ": a body that ends in a point needs a base in one piece, without holes"
                      " and cavities; expected a profile that ends with a scale above 0, or a"
                      " straight extrusion");
    }
}

// Quantities, which files of base and layers have no place for, go into what is left out.
template <int Dim>
void leave_out_fields(const SimplexMesh<Dim>& base,
                      const MeshExtras<Dim>& fields,
                      BodyReport& report) {
    for (const std::string& name : quantity_names(base, fields)) {
        report.left_out += (report.left_out.empty() ? "" : ", ") + name
                           + " (base and layers have no place for it)";
    }
}

}  // namespace

template <int Dim>
void describe_base(const SimplexMesh<Dim>& base, BodyReport& report) {
    report.base_vertices = base.vertex_count();
    report.base_cells = base.cell_count();
    report.base_volume = total_volume(base);
    report.base_edge = mean_edge<Dim>(base);
}

template <int Dim>
Body<Dim> extrude_and_prove(const SimplexMesh<Dim - 1>& base,
                            const MeshExtras<Dim - 1>& fields,
                            const BodyRequest& request,
                            const ExtrusionRequest& extrusion,
                            BodyReport report,
                            StageClock& clock) {
    describe_base<Dim - 1>(base, report);
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

template void describe_base<2>(const SimplexMesh<2>&, BodyReport&);
template void describe_base<3>(const SimplexMesh<3>&, BodyReport&);
template Body<3> extrude_and_prove<3>(const SimplexMesh<2>&,
                                      const MeshExtras<2>&,
                                      const BodyRequest&,
                                      const ExtrusionRequest&,
                                      BodyReport,
                                      StageClock&);
template Body<4> extrude_and_prove<4>(const SimplexMesh<3>&,
                                      const MeshExtras<3>&,
                                      const BodyRequest&,
                                      const ExtrusionRequest&,
                                      BodyReport,
                                      StageClock&);

}  // namespace pent::mesher
