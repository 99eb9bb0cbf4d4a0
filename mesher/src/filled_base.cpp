#include "base_mesh.h"
#include "body_steps.h"
#include "fill_target.h"
#include "requested_layers.h"
#include "size_limits.h"

#include <cmath>
#include <utility>

namespace pent::mesher {

namespace {

// Fixes the number of layers first, then searches the edge length that gives as many tetrahedra as
// the wanted cells are over that many layers.
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
        // Of edges e there are regular / e^3 tetrahedra and height / (0.7 e) slabs of 4 cells each.
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

}  // namespace

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

template SimplexMesh<3> filled_base<3>(
    const SurfaceFile&, const BodyRequest&, ExtrusionRequest&, BodyReport&, StageClock&);
template SimplexMesh<3> filled_base<4>(
    const SurfaceFile&, const BodyRequest&, ExtrusionRequest&, BodyReport&, StageClock&);

}  // namespace pent::mesher
